// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"

namespace rprr {

/// A camera as calibrated: its lens, and the pinhole camera that its rectified images have.
struct LensCalibration {
  Camera camera;                   // of the raw image, without its distortion
  std::vector<double> distortion;  // k1 k2 p1 p2 k3 [k4 k5 k6], as OpenCV has it; empty or 0: none
  Camera rectified;                // of the rectified image

  /// One without distortion.
  static LensCalibration pinhole(const Camera& camera) { return {camera, {}, camera}; }
};

/// Takes the distortion out of a camera's images, by maps computed once.
class Rectification {
 public:
  /// Errors: cameras that are not valid, a number of distortion coefficients that OpenCV does not
  /// know, numbers that are not finite.
  static Result<Rectification> create(const LensCalibration& calibration);

  /// Whether images change at all.
  bool needed() const { return !map_.empty(); }
  /// CV_8UC3, interpolated. The same pixels where not needed.
  cv::Mat colour(const cv::Mat& image) const;
  /// CV_16UC1, each the nearest pixel's: depth must not be mixed across edges. Outside: 0.
  cv::Mat depth(const cv::Mat& counts) const;

 private:
  cv::Mat map_;  // CV_16SC2 and what remap needs besides
  cv::Mat interpolation_;
  cv::Mat nearest_;  // CV_16SC2, whole pixels
};

}  // namespace rprr
