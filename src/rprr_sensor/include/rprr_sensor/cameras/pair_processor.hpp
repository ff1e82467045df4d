// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/result.hpp"
#include "rprr_geometry/rgbd_image.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_sensor/cameras/depth_registration.hpp"
#include "rprr_sensor/cameras/frame_pairing.hpp"
#include "rprr_sensor/cameras/raw_disparity.hpp"
#include "rprr_sensor/cameras/rectification.hpp"

namespace rprr {

/// All that is known of an RGB-D camera's two lenses.
struct RgbdCalibration {
  LensCalibration colour;
  LensCalibration depth;  // used only where RPRR registers
  /// Maps points of the depth camera's optical frame into the colour camera's.
  Pose colour_from_depth = Pose::Identity();
  DisparityModel disparity;  // used only for DepthFormat::disparity
};

/// What a Kinect's cameras are nominally, for images of that size: 525 pixels of focal length for
/// colour and 580 for depth at 640 columns, no distortion, colour 2.5 cm to the right of depth.
RgbdCalibration nominal_calibration(int width, int height);

/// Makes what RPRR takes of what a device gives: rectified colour, depth registered to it in
/// millimetres.
class PairProcessor {
 public:
  static Result<PairProcessor> create(const RgbdCalibration& calibration, DepthFormat format);

  /// Errors: images of another size than the calibration's.
  Result<RgbdImage> process(const DevicePair& pair);

 private:
  PairProcessor(const RgbdCalibration& calibration, DepthFormat format, Rectification colour,
                Rectification depth);

  RgbdCalibration calibration_;
  DepthFormat format_;
  Rectification colour_;
  Rectification depth_;
  DisparityTable disparity_;
  DepthRegistration registration_;
};

}  // namespace rprr
