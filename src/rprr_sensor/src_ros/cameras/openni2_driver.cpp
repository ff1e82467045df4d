// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/openni2_driver.hpp"

#include <OpenNI.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <utility>

#include "rprr_sensor/cameras/usb_access.hpp"

namespace rprr {
namespace {

// PrimeSense's own and Asus's cameras.
const std::vector<UsbId> kCameras = {
    {0x1d27, 0x0200}, {0x1d27, 0x0300}, {0x1d27, 0x0401}, {0x1d27, 0x0500}, {0x1d27, 0x0600},
    {0x1d27, 0x0601}, {0x1d27, 0x0609}, {0x1d27, 0x1280}, {0x1d27, 0x2100}, {0x1d27, 0x2200}};

/// OpenNI2's own words for what went wrong last, on one line.
std::string last_words() {
  std::istringstream words(openni::OpenNI::getExtendedError());
  std::string text, word;
  while (words >> word) text += (text.empty() ? "" : " ") + word;
  return text.empty() ? "no further reason given" : text;
}

std::string serial_of(const openni::Device& device) {
  std::array<char, 256> text{};
  int size = static_cast<int>(text.size()) - 1;
  const auto status = device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, text.data(), &size);
  return status == openni::STATUS_OK ? std::string(text.data()) : std::string();
}

class OpenNi2Device : public RgbdDevice, private openni::OpenNI::DeviceDisconnectedListener {
 public:
  OpenNi2Device() { openni::OpenNI::addDeviceDisconnectedListener(this); }
  ~OpenNi2Device() override {
    openni::OpenNI::removeDeviceDisconnectedListener(this);
    // The file driver's thread looks at the list of streams without a lock, but seldom once both
    // have stopped.
    colour_.stop();
    depth_.stop();
    colour_.destroy();  // before the device that they belong to
    depth_.destroy();
    device_.close();
  }
  OpenNi2Device(const OpenNi2Device&) = delete;
  OpenNi2Device& operator=(const OpenNi2Device&) = delete;

  /// These two return what is wrong, or nothing.
  std::string open(const std::string& uri);
  std::string start(const DeviceModes& modes);

  const std::string& serial() const override { return serial_; }
  DepthFormat depth_format() const override { return format_; }
  Result<std::optional<DeviceImage>> next(Duration timeout) override;
  std::string control(const DeviceControls& controls) override;

 private:
  // On a thread of OpenNI2's.
  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    if (uri_ == info->getUri()) gone_ = true;
  }
  std::string make_stream(openni::VideoStream& stream, openni::SensorType type,
                          openni::PixelFormat format, const DeviceModes& modes);
  std::string choose_registration(RegistrationChoice choice);
  Result<std::optional<DeviceImage>> read(DeviceImage::Kind kind);

  std::string uri_;
  std::string serial_;
  openni::Device device_;
  openni::VideoStream colour_;
  openni::VideoStream depth_;
  DepthFormat format_ = DepthFormat::registered_mm;
  std::atomic<bool> gone_{false};
};

std::string OpenNi2Device::open(const std::string& uri) {
  uri_ = uri;
  if (device_.open(uri.c_str()) != openni::STATUS_OK) return uri + ": " + last_words();
  serial_ = serial_of(device_);
  return {};
}

std::string OpenNi2Device::make_stream(openni::VideoStream& stream, openni::SensorType type,
                                       openni::PixelFormat format, const DeviceModes& modes) {
  const std::string what = type == openni::SENSOR_COLOR ? "colour" : "depth";
  if (device_.getSensorInfo(type) == nullptr || stream.create(device_, type) != openni::STATUS_OK) {
    return uri_ + " has no " + what + " stream: " + last_words();
  }
  if (!device_.isFile()) {
    openni::VideoMode mode;
    mode.setResolution(modes.width, modes.height);
    mode.setFps(modes.rate);
    mode.setPixelFormat(format);
    if (stream.setVideoMode(mode) != openni::STATUS_OK) {
      return "the " + what + " stream has no mode of " + std::to_string(modes.width) + "x" +
             std::to_string(modes.height) + " at " + std::to_string(modes.rate) +
             " images a second (~width, ~height, ~fps): " + last_words();
    }
    // Many cameras mirror by default, as if they were mirrors.
    stream.setMirroringEnabled(false);
  }
  if (stream.getVideoMode().getPixelFormat() != format) {
    return "the " + what + " stream has another pixel format than " +
           (type == openni::SENSOR_COLOR ? "RGB888" : "1 mm of depth");
  }
  return {};
}

std::string OpenNi2Device::choose_registration(RegistrationChoice choice) {
  constexpr auto kToColour = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
  const bool own = choice == RegistrationChoice::own;
  if (device_.isFile()) {
    // Recordings do not tell; what records them registers.
    format_ = own ? DepthFormat::unregistered_mm : DepthFormat::registered_mm;
    return {};
  }
  const auto wanted = own ? openni::IMAGE_REGISTRATION_OFF : kToColour;
  const bool can = device_.isImageRegistrationModeSupported(kToColour);
  const bool set = (own && !can) || (device_.isImageRegistrationModeSupported(wanted) &&
                                     device_.setImageRegistrationMode(wanted) == openni::STATUS_OK);
  if (!set && choice != RegistrationChoice::automatic) {
    return "the camera does not " +
           std::string(own ? "stop registering depth to colour; set ~registration to device"
                           : "register depth to colour; set ~registration to own");
  }
  const bool registered = device_.getImageRegistrationMode() == kToColour;
  format_ = registered ? DepthFormat::registered_mm : DepthFormat::unregistered_mm;
  return {};
}

std::string OpenNi2Device::start(const DeviceModes& modes) {
  std::string fault =
      make_stream(colour_, openni::SENSOR_COLOR, openni::PIXEL_FORMAT_RGB888, modes);
  if (fault.empty()) {
    fault = make_stream(depth_, openni::SENSOR_DEPTH, openni::PIXEL_FORMAT_DEPTH_1_MM, modes);
  }
  if (fault.empty()) fault = choose_registration(modes.registration);
  if (!fault.empty()) return fault;
  if (auto* playback = device_.getPlaybackControl(); playback != nullptr && device_.isFile()) {
    // At the end of a file that is not repeated its driver spins, and crashes when it is closed.
    playback->setRepeatEnabled(true);
    playback->setSpeed(1.0f);
  } else {
    device_.setDepthColorSyncEnabled(true);  // where it can
  }
  if (depth_.start() != openni::STATUS_OK || colour_.start() != openni::STATUS_OK) {
    return "the camera does not start its streams: " + last_words() +
           " Does it share a USB controller with another camera?";
  }
  return {};
}

Result<std::optional<DeviceImage>> OpenNi2Device::next(Duration timeout) {
  if (gone_) {
    return Error{"the camera" + (serial_.empty() ? "" : " " + serial_) +
                 " is gone (unplugged or without power); waiting for it to come back"};
  }
  std::array<openni::VideoStream*, 2> streams = {&colour_, &depth_};
  int ready = -1;
  const auto status = openni::OpenNI::waitForAnyStream(streams.data(), 2, &ready,
                                                       static_cast<int>(timeout / 1000000));
  if (status == openni::STATUS_TIME_OUT) return std::optional<DeviceImage>();
  if (status != openni::STATUS_OK) return Error{"the camera does not deliver: " + last_words()};
  return read(ready == 0 ? DeviceImage::Kind::colour : DeviceImage::Kind::depth);
}

Result<std::optional<DeviceImage>> OpenNi2Device::read(DeviceImage::Kind kind) {
  const bool is_colour = kind == DeviceImage::Kind::colour;
  openni::VideoFrameRef frame;
  const auto status = (is_colour ? colour_ : depth_).readFrame(&frame);
  if (status != openni::STATUS_OK || !frame.isValid()) {
    return Error{"the camera gives no image: " + last_words()};
  }
  DeviceImage image{kind, {}, static_cast<Duration>(frame.getTimestamp()) * 1000};
  // OpenNI2 keeps the pixels and hands them out as const; they are only read here.
  const cv::Mat pixels(frame.getHeight(), frame.getWidth(), is_colour ? CV_8UC3 : CV_16UC1,
                       const_cast<void*>(frame.getData()),
                       static_cast<std::size_t>(frame.getStrideInBytes()));
  if (is_colour) {
    cv::cvtColor(pixels, image.pixels, cv::COLOR_RGB2BGR);
  } else {
    image.pixels = pixels.clone();
  }
  return std::optional<DeviceImage>(std::move(image));
}

std::string OpenNi2Device::control(const DeviceControls& controls) {
  const bool wishes = !controls.auto_exposure || !controls.auto_white_balance;
  auto* settings = colour_.getCameraSettings();
  if (settings == nullptr || device_.isFile()) {
    return wishes ? "this camera (or recording) cannot lock exposure and white balance" : "";
  }
  std::string refused;
  const auto note = [&](openni::Status status, bool matters, const std::string& what) {
    if (status != openni::STATUS_OK && matters) refused += " " + what;
  };
  note(settings->setAutoExposureEnabled(controls.auto_exposure), !controls.auto_exposure,
       "~auto_exposure");
  note(settings->setAutoWhiteBalanceEnabled(controls.auto_white_balance),
       !controls.auto_white_balance, "~auto_white_balance");
  if (!controls.auto_exposure && controls.exposure > 0) {
    note(settings->setExposure(controls.exposure), true, "~exposure");
  }
  if (!controls.auto_exposure && controls.gain > 0) {
    note(settings->setGain(controls.gain), true, "~gain");
  }
  return refused.empty() ? refused : "the camera does not take" + refused;
}

class OpenNi2Driver : public RgbdDriver {
 public:
  OpenNi2Driver() : ready_(openni::OpenNI::initialize() == openni::STATUS_OK) {}
  ~OpenNi2Driver() override {
    if (ready_) openni::OpenNI::shutdown();
  }
  OpenNi2Driver(const OpenNi2Driver&) = delete;
  OpenNi2Driver& operator=(const OpenNi2Driver&) = delete;

  std::string name() const override { return "OpenNI2"; }
  Result<std::unique_ptr<RgbdDevice>> open(const std::string& serial,
                                           const DeviceModes& modes) override;

 private:
  bool ready_;
};

/// Where a device named so may be: itself if it is a URI or a file, else all that are there.
std::vector<std::string> candidates(const std::string& name) {
  std::error_code ignored;
  const bool is_place = name.find('/') != std::string::npos ||
                        name.find("://") != std::string::npos ||
                        std::filesystem::exists(name, ignored);
  if (!name.empty() && is_place) return {name};
  openni::Array<openni::DeviceInfo> devices;
  openni::OpenNI::enumerateDevices(&devices);
  std::vector<std::string> uris;
  uris.reserve(static_cast<std::size_t>(devices.getSize()));
  for (int i = 0; i < devices.getSize(); ++i) uris.emplace_back(devices[i].getUri());
  return uris;
}

Result<std::unique_ptr<RgbdDevice>> OpenNi2Driver::open(const std::string& serial,
                                                        const DeviceModes& modes) {
  if (!ready_) return Error{"cannot be initialised: " + last_words()};
  const auto uris = candidates(serial);
  std::string seen;
  for (const std::string& uri : uris) {
    auto device = std::make_unique<OpenNi2Device>();
    std::string fault = device->open(uri);
    if (!fault.empty()) {
      if (serial == uri) return Error{"cannot open " + fault};
      seen += " (" + fault + ")";
    } else if (!serial.empty() && serial != uri && serial != device->serial()) {
      seen += " '" + device->serial() + "'";
    } else {
      fault = device->start(modes);
      if (!fault.empty()) return Error{fault};
      return std::unique_ptr<RgbdDevice>(std::move(device));
    }
  }
  if (!serial.empty() && !seen.empty()) {
    return Error{"no camera or recording '" + serial + "' opens; there are:" + seen};
  }
  return Error{why_not_open(find_usb_devices(kCameras), "libopenni2-0", "") + seen};
}

}  // namespace

std::unique_ptr<RgbdDriver> make_openni2_driver() {
  return std::make_unique<OpenNi2Driver>();
}

}  // namespace rprr
