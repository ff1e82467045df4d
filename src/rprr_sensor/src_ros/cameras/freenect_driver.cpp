// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/freenect_driver.hpp"

#include <libfreenect.h>
#include <sys/time.h>

#include <deque>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "rprr_sensor/cameras/device_clock.hpp"
#include "rprr_sensor/cameras/usb_access.hpp"

// fakenect, which plays recordings in libfreenect's place, lacks these: they may be null.
#pragma weak freenect_list_device_attributes
#pragma weak freenect_free_device_attributes
#pragma weak freenect_set_flag

namespace rprr {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr int kRate = 30;
constexpr double kTicksPerSecond = 60e6;
constexpr std::size_t kMostQueued = 8;

// Cameras of the Kinect for Xbox 360 and of the Kinect for Windows.
const std::vector<UsbId> kCameras = {{0x045e, 0x02ae}, {0x045e, 0x02bf}};

/// A context of libfreenect's.
using Context = std::unique_ptr<freenect_context, int (*)(freenect_context*)>;

/// libfreenect's messages go nowhere: what matters comes back as status.
void no_log(freenect_context* /*context*/, freenect_loglevel /*level*/, const char* /*text*/) {
}

Result<Context> make_context() {
  freenect_context* raw = nullptr;
  if (freenect_init(&raw, nullptr) < 0 || raw == nullptr) {
    return Error{"cannot be initialised: is USB to be had on this machine?"};
  }
  Context context(raw, freenect_shutdown);
  freenect_set_log_level(raw, FREENECT_LOG_ERROR);
  freenect_set_log_callback(raw, no_log);
  freenect_select_subdevices(raw, FREENECT_DEVICE_CAMERA);
  return context;
}

std::vector<std::string> list_serials(freenect_context* context) {
  std::vector<std::string> serials;
  if (freenect_list_device_attributes == nullptr || freenect_free_device_attributes == nullptr) {
    serials.resize(static_cast<std::size_t>(std::max(freenect_num_devices(context), 0)));
    return serials;
  }
  freenect_device_attributes* first = nullptr;
  if (freenect_list_device_attributes(context, &first) <= 0) return serials;
  for (const auto* entry = first; entry != nullptr; entry = entry->next) {
    serials.emplace_back(entry->camera_serial != nullptr ? entry->camera_serial : "");
  }
  freenect_free_device_attributes(first);
  return serials;
}

class FreenectDevice : public RgbdDevice {
 public:
  /// Takes the opened device over.
  FreenectDevice(Context context, freenect_device* device, std::string serial)
      : context_(std::move(context)), device_(device), serial_(std::move(serial)) {
    freenect_set_user(device_, this);
  }
  ~FreenectDevice() override {
    freenect_stop_depth(device_);
    freenect_stop_video(device_);
    freenect_close_device(device_);
  }
  FreenectDevice(const FreenectDevice&) = delete;
  FreenectDevice& operator=(const FreenectDevice&) = delete;

  /// Empty if both streams run.
  std::string start(RegistrationChoice registration);

  const std::string& serial() const override { return serial_; }
  DepthFormat depth_format() const override { return format_; }
  Result<std::optional<DeviceImage>> next(Duration timeout) override;
  std::string control(const DeviceControls& controls) override;

 private:
  static void on_depth(freenect_device* device, void* pixels, std::uint32_t ticks);
  static void on_video(freenect_device* device, void* pixels, std::uint32_t ticks);
  void keep(DeviceImage image);

  Context context_;
  freenect_device* device_;
  std::string serial_;
  DepthFormat format_ = DepthFormat::registered_mm;
  TickCounter clock_{kTicksPerSecond};
  std::deque<DeviceImage> queue_;
};

std::string FreenectDevice::start(RegistrationChoice registration) {
  // In our own registration raw disparity is wanted: millimetres would be rounded twice.
  const bool own = registration == RegistrationChoice::own;
  format_ = own ? DepthFormat::disparity : DepthFormat::registered_mm;
  const auto video = freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB);
  const auto depth = freenect_find_depth_mode(
      FREENECT_RESOLUTION_MEDIUM, own ? FREENECT_DEPTH_11BIT : FREENECT_DEPTH_REGISTERED);
  if (freenect_set_video_mode(device_, video) < 0 || freenect_set_depth_mode(device_, depth) < 0) {
    return "the camera does not take the modes: 640x480 colour, depth " +
           std::string(own ? "of 11 bits"
                           : "registered by the device (~registration: own is the "
                             "way out)");
  }
  freenect_set_video_callback(device_, &FreenectDevice::on_video);
  freenect_set_depth_callback(device_, &FreenectDevice::on_depth);
  if (freenect_start_video(device_) < 0 || freenect_start_depth(device_) < 0) {
    return "the camera does not start its streams: does it share a USB controller with another "
           "camera?";
  }
  return {};
}

Result<std::optional<DeviceImage>> FreenectDevice::next(Duration timeout) {
  if (queue_.empty()) {
    timeval wait{0, static_cast<suseconds_t>(timeout / 1000)};
    if (freenect_process_events_timeout(context_.get(), &wait) < 0) {
      return Error{"the camera" + (serial_.empty() ? "" : " " + serial_) +
                   " is gone (unplugged, without power, or the end of a recording); waiting for "
                   "it to come back"};
    }
  }
  if (queue_.empty()) return std::optional<DeviceImage>();
  std::optional<DeviceImage> image = std::move(queue_.front());
  queue_.pop_front();
  return image;
}

std::string FreenectDevice::control(const DeviceControls& controls) {
  if (freenect_set_flag == nullptr) {
    return controls.auto_exposure && controls.auto_white_balance
               ? std::string()
               : "this libfreenect (fakenect?) cannot lock exposure and white balance";
  }
  const auto flag = [](bool on) { return on ? FREENECT_ON : FREENECT_OFF; };
  std::string refused;
  if (freenect_set_flag(device_, FREENECT_AUTO_EXPOSURE, flag(controls.auto_exposure)) < 0) {
    refused += " ~auto_exposure";
  }
  if (freenect_set_flag(device_, FREENECT_AUTO_WHITE_BALANCE, flag(controls.auto_white_balance)) <
      0) {
    refused += " ~auto_white_balance";
  }
  if (!controls.auto_exposure && (controls.exposure > 0 || controls.gain > 0)) {
    refused += " ~exposure, ~gain (libfreenect can only keep what auto exposure found)";
  }
  return refused.empty() ? refused : "the camera does not take" + refused;
}

void FreenectDevice::on_depth(freenect_device* device, void* pixels, std::uint32_t ticks) {
  auto& self = *static_cast<FreenectDevice*>(freenect_get_user(device));
  const cv::Mat seen(kHeight, kWidth, CV_16UC1, pixels);
  self.keep({DeviceImage::Kind::depth, seen.clone(), self.clock_.read(ticks)});
}

void FreenectDevice::on_video(freenect_device* device, void* pixels, std::uint32_t ticks) {
  auto& self = *static_cast<FreenectDevice*>(freenect_get_user(device));
  DeviceImage image{DeviceImage::Kind::colour, {}, self.clock_.read(ticks)};
  cv::cvtColor(cv::Mat(kHeight, kWidth, CV_8UC3, pixels), image.pixels, cv::COLOR_RGB2BGR);
  self.keep(std::move(image));
}

void FreenectDevice::keep(DeviceImage image) {
  if (queue_.size() >= kMostQueued) queue_.pop_front();
  queue_.push_back(std::move(image));
}

class FreenectDriver : public RgbdDriver {
 public:
  std::string name() const override { return "libfreenect"; }
  Result<std::unique_ptr<RgbdDevice>> open(const std::string& serial,
                                           const DeviceModes& modes) override;
};

Result<std::unique_ptr<RgbdDevice>> FreenectDriver::open(const std::string& serial,
                                                         const DeviceModes& modes) {
  if (modes.width != kWidth || modes.height != kHeight || modes.rate != kRate) {
    return Error{
        "a Kinect gives 640x480 at 30 images a second: set ~width, ~height and ~fps so, "
        "and ~max_rate for fewer images"};
  }
  auto context = make_context();
  if (!context) return Error{context.reason()};
  const auto explain = [] {
    return why_not_open(find_usb_devices(kCameras), "libfreenect0.5", "gspca_kinect");
  };
  const auto serials = list_serials(context->get());
  if (serials.empty()) return Error{explain()};
  freenect_device* raw = nullptr;
  std::string chosen = serial;
  if (serial.empty()) {
    chosen = serials.front();
    freenect_open_device(context->get(), &raw, 0);
  } else if (freenect_open_device_by_camera_serial(context->get(), &raw, serial.c_str()) < 0) {
    std::string there;
    for (const auto& other : serials) there += " '" + other + "'";
    return Error{"no camera with serial " + serial + " opens; there are:" + there};
  }
  if (raw == nullptr) return Error{explain()};
  auto device = std::make_unique<FreenectDevice>(std::move(*context), raw, chosen);
  const std::string fault = device->start(modes.registration);
  if (!fault.empty()) return Error{fault};
  return std::unique_ptr<RgbdDevice>(std::move(device));
}

}  // namespace

std::unique_ptr<RgbdDriver> make_freenect_driver() {
  return std::make_unique<FreenectDriver>();
}

}  // namespace rprr
