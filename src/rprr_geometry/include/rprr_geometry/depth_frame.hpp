// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "rprr_geometry/result.hpp"

namespace rprr {

/// REP-118: how depth is written in an image of a type.
template <typename T>
struct DepthTraits;

template <>
struct DepthTraits<std::uint16_t> {
  static constexpr int cv_type = CV_16UC1;
  static bool valid(std::uint16_t depth) { return depth != 0; }
  static std::uint16_t invalid() { return 0; }
};

template <>
struct DepthTraits<float> {
  static constexpr int cv_type = CV_32FC1;
  static bool valid(float depth) { return std::isfinite(depth) && depth > 0.0f; }
  static float invalid() { return std::nanf(""); }
};

/// A depth image in whole counts of a stated unit, as sensors and files have it. "Bit-exact" means
/// these counts.
/// Ownership: the pixels are shared, not copied, with whoever made the frame. Nobody writes to
/// them.
struct DepthFrame {
  cv::Mat counts;       ///< CV_16UC1; 0: no reading
  double unit = 0.001;  ///< depth that one count stands for [m per count]

  int width() const { return counts.cols; }
  int height() const { return counts.rows; }
  bool empty() const { return counts.empty(); }
  /// Depth at (column u, row v) [m]; 0: no reading.
  double metres(int u, int v) const { return counts.at<std::uint16_t>(v, u) * unit; }
};

/// What numbers in depth images stand for.
struct DepthUnits {
  double of_counts = 0.001;   ///< depth of one count of 16UC1 [m]; REP-118 says 1 mm
  double for_metres = 0.001;  ///< step that 32FC1 is rounded to [m]
};

/// A frame of any of REP-118's images. 16UC1 is taken as counts without a copy. 32FC1 [m] becomes
/// counts, rounded; what is not finite, not positive or beyond 65535 counts becomes 0.
/// Errors: another type, an empty image, a unit that is not positive.
Result<DepthFrame> depth_frame_from_image(const cv::Mat& image, const DepthUnits& units);

/// A new 32FC1 image in metres with NaN where there is no reading.
cv::Mat to_float_image(const DepthFrame& frame);
/// A 16UC1 image in millimetres: the frame's own pixels if that is its unit, else a rounded copy.
cv::Mat to_millimetre_image(const DepthFrame& frame);

/// The random error of a Kinect's depth grows with the square of the depth: 1.425e-3 z^2 [m], half
/// of its quantisation step (Khoshelham and Oude Elberink 2012).
constexpr double kKinectNoise = 1.425e-3;  // [1/m]
constexpr double kLeastDepthSigma = 1e-3;  // [m] what registration and calibration leave

/// Standard deviation of a Kinect-class depth reading at z [m].
inline double depth_sigma(double z) {
  return kKinectNoise * z * z + kLeastDepthSigma;
}

}  // namespace rprr
