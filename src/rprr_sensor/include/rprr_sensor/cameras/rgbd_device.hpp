// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// What the depth pixels of a device mean. All are CV_16UC1.
enum class DepthFormat {
  registered_mm,    // millimetres, 0 = none, each pixel that of the colour image
  unregistered_mm,  // millimetres, 0 = none, as the depth camera sees it
  disparity         // a Kinect's 11 bits, as the depth camera sees it: see raw_disparity.hpp
};

/// Who brings depth into the colour camera's image.
enum class RegistrationChoice {
  automatic,  // the device where it can, else RPRR
  device,     // the device; one that cannot is refused
  own         // RPRR, from the calibration of both cameras
};

/// One image as it came from a device. The pixels are its own.
struct DeviceImage {
  enum class Kind { colour, depth };
  Kind kind = Kind::colour;
  cv::Mat pixels;            // CV_8UC3 (BGR), or CV_16UC1 in the device's DepthFormat
  Duration device_time = 0;  // ns on the device's own clock, which is both streams'
};

/// How the streams are to run.
struct DeviceModes {
  int width = 640;   // pixels of both images
  int height = 480;  // of colour and depth [px]
  int rate = 30;     // frames per second of both streams
  RegistrationChoice registration = RegistrationChoice::automatic;
};

/// What can be changed while a device runs.
struct DeviceControls {
  bool auto_exposure = true;
  bool auto_white_balance = true;
  int exposure = 0;  // in the device's units, without auto_exposure; 0: as it is
  int gain = 0;      // in the device's units, without auto_exposure; 0: as it is
};

/// An RGB-D camera that streams. One thread uses it. Destruction stops and closes it.
class RgbdDevice {
 public:
  virtual ~RgbdDevice() = default;

  /// Empty where the device has none.
  virtual const std::string& serial() const = 0;
  virtual DepthFormat depth_format() const = 0;
  /// The next image, or none within about `timeout`. An error: the device is lost; destroy it.
  virtual Result<std::optional<DeviceImage>> next(Duration timeout) = 0;
  /// Returns what could not be set and why; empty if all was.
  virtual std::string control(const DeviceControls& controls) = 0;
};

/// A library that knows a family of RGB-D cameras. One thread uses it. It outlives its devices.
class RgbdDriver {
 public:
  virtual ~RgbdDriver() = default;

  /// "libfreenect", for messages.
  virtual std::string name() const = 0;
  /// Opens the device with that serial (or what else the driver takes for a name), the first there
  /// is where `serial` is empty, and starts both streams. Errors tell what is there, what is
  /// wrong and the remedy.
  virtual Result<std::unique_ptr<RgbdDevice>> open(const std::string& serial,
                                                   const DeviceModes& modes) = 0;
};

}  // namespace rprr
