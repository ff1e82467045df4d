// SPDX-License-Identifier: BSD-3-Clause
//
// A camera for OpenNI2 as its drivers make them: shows the images colour.png and depth.png of the
// folder $RPRR_TEST_CAMERA while there is a file "plugged" in it. What is set of a stream it notes
// there, in files "set_<property>".
#include <Driver/OniDriverAPI.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <thread>
#include <vector>

#define XN_NEW(type, argument) new type(argument)
#define XN_DELETE(pointer) delete pointer

namespace {

using oni::driver::DeviceBase;
using oni::driver::StreamBase;

constexpr const char* kUri = "test://camera";
constexpr const char* kSerial = "TEST1";
constexpr int kPeriod = 33333;  // microseconds

std::string folder() {
  const char* path = std::getenv("RPRR_TEST_CAMERA");
  return path != nullptr ? path : "/nonexistent";
}

bool plugged() {
  std::error_code ignored;
  return std::filesystem::exists(folder() + "/plugged", ignored);
}

template <typename T>
OniStatus give(const T& value, void* data, int* size) {
  if (*size < static_cast<int>(sizeof value)) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof value);
  *size = sizeof value;
  return ONI_STATUS_OK;
}

class Stream : public StreamBase {
 public:
  explicit Stream(OniSensorType type) {
    if (type == ONI_SENSOR_COLOR) {
      cv::cvtColor(cv::imread(folder() + "/colour.png"), pixels_, cv::COLOR_BGR2RGB);
    } else {
      pixels_ = cv::imread(folder() + "/depth.png", cv::IMREAD_UNCHANGED);
    }
    mode_ = {type == ONI_SENSOR_COLOR ? ONI_PIXEL_FORMAT_RGB888 : ONI_PIXEL_FORMAT_DEPTH_1_MM,
             pixels_.cols, pixels_.rows, 30};
    type_ = type;
  }
  ~Stream() override { stop(); }

  OniStatus start() override {
    runs_ = true;
    thread_ = std::thread([this] { run(); });
    return ONI_STATUS_OK;
  }
  void stop() override {
    runs_ = false;
    if (thread_.joinable()) thread_.join();
  }
  OniBool isPropertySupported(int property) override {
    int size = 64;
    char data[64];
    return getProperty(property, data, &size) == ONI_STATUS_OK ? TRUE : FALSE;
  }
  OniStatus getProperty(int property, void* data, int* size) override {
    switch (property) {
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return give(mode_, data, size);
      case ONI_STREAM_PROPERTY_MIRRORING:
      case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
      case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
        return give(OniBool{FALSE}, data, size);
      case ONI_STREAM_PROPERTY_STRIDE:  // recordings without these two are not played
        return give(static_cast<int>(pixels_.step), data, size);
      case ONI_STREAM_PROPERTY_CROPPING:
        return give(OniCropping{}, data, size);
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return give(int{10000}, data, size);
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return give(1.0f, data, size);
      default:
        return ONI_STATUS_NOT_SUPPORTED;
    }
  }
  OniStatus setProperty(int property, const void* data, int size) override {
    if (property != ONI_STREAM_PROPERTY_VIDEO_MODE) {
      int value = 0;
      std::memcpy(&value, data, std::min(sizeof value, static_cast<std::size_t>(size)));
      std::ofstream(folder() + "/set_" + std::to_string(property)) << value;
      return ONI_STATUS_OK;
    }
    return std::memcmp(data, &mode_, sizeof mode_) == 0 ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }

 private:
  void run() {
    for (int number = 1; runs_; ++number) {
      std::this_thread::sleep_for(std::chrono::microseconds(kPeriod));
      if (!plugged()) continue;
      OniFrame* frame = getServices().acquireFrame();
      if (frame == nullptr) continue;
      frame->frameIndex = number;
      frame->timestamp = static_cast<std::uint64_t>(number) * kPeriod;
      frame->videoMode = mode_;
      frame->width = mode_.resolutionX;
      frame->height = mode_.resolutionY;
      frame->croppingEnabled = FALSE;
      frame->cropOriginX = frame->cropOriginY = 0;
      frame->sensorType = type_;
      frame->stride = static_cast<int>(pixels_.step);
      frame->dataSize = static_cast<int>(pixels_.total() * pixels_.elemSize());
      std::memcpy(frame->data, pixels_.data, static_cast<std::size_t>(frame->dataSize));
      raiseNewFrame(frame);
      getServices().releaseFrame(frame);
    }
  }

  OniSensorType type_;
  OniVideoMode mode_;
  cv::Mat pixels_;
  std::atomic<bool> runs_{false};
  std::thread thread_;
};

class Device : public DeviceBase {
 public:
  Device() {
    for (const auto type : {ONI_SENSOR_COLOR, ONI_SENSOR_DEPTH}) {
      const Stream stream(type);
      OniVideoMode mode;
      int size = sizeof mode;
      const_cast<Stream&>(stream).getProperty(ONI_STREAM_PROPERTY_VIDEO_MODE, &mode, &size);
      modes_.push_back(mode);
    }
    sensors_ = {{ONI_SENSOR_COLOR, 1, &modes_[0]}, {ONI_SENSOR_DEPTH, 1, &modes_[1]}};
  }
  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = sensors_.data();
    *count = static_cast<int>(sensors_.size());
    return ONI_STATUS_OK;
  }
  StreamBase* createStream(OniSensorType type) override { return new Stream(type); }
  void destroyStream(StreamBase* stream) override { delete stream; }
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode /*mode*/) override {
    return TRUE;
  }
  OniBool isPropertySupported(int property) override {
    return property == ONI_DEVICE_PROPERTY_SERIAL_NUMBER ||
                   property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION
               ? TRUE
               : FALSE;
  }
  OniStatus getProperty(int property, void* data, int* size) override {
    if (property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return give(registration_, data, size);
    if (property != ONI_DEVICE_PROPERTY_SERIAL_NUMBER) return ONI_STATUS_NOT_SUPPORTED;
    std::strncpy(static_cast<char*>(data), kSerial, static_cast<std::size_t>(*size));
    return ONI_STATUS_OK;
  }
  OniStatus setProperty(int property, const void* data, int size) override {
    if (property != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ||
        size != static_cast<int>(sizeof registration_)) {
      return ONI_STATUS_NOT_SUPPORTED;
    }
    std::memcpy(&registration_, data, sizeof registration_);
    return ONI_STATUS_OK;
  }

 private:
  std::vector<OniVideoMode> modes_;
  std::vector<OniSensorInfo> sensors_;
  OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
};

class Driver : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {
    std::strncpy(info_.uri, kUri, sizeof info_.uri - 1);
    std::strncpy(info_.vendor, "RPRR", sizeof info_.vendor - 1);
    std::strncpy(info_.name, "test", sizeof info_.name - 1);
  }
  ~Driver() override { shutdown(); }
  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    look();
    runs_ = true;
    thread_ = std::thread([this] {
      while (runs_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        look();
      }
    });
    return ONI_STATUS_OK;
  }
  void shutdown() override {
    runs_ = false;
    if (thread_.joinable()) thread_.join();
  }
  DeviceBase* deviceOpen(const char* /*uri*/, const char* /*mode*/) override {
    return plugged() ? new Device() : nullptr;
  }
  void deviceClose(DeviceBase* device) override { delete device; }

 private:
  void look() {
    const bool now = plugged();
    if (now == there_) return;
    there_ = now;
    now ? deviceConnected(&info_) : deviceDisconnected(&info_);
  }

  OniDeviceInfo info_{};
  bool there_ = false;
  std::atomic<bool> runs_{false};
  std::thread thread_;
};

}  // namespace

ONI_EXPORT_DRIVER(Driver)
