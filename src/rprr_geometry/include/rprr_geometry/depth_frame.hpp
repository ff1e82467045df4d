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
  static float to_metres(std::uint16_t depth) { return static_cast<float>(depth) * 0.001f; }
  static std::uint16_t invalid() { return 0; }
};

template <>
struct DepthTraits<float> {
  static constexpr int cv_type = CV_32FC1;
  static bool valid(float depth) { return std::isfinite(depth) && depth > 0.0f; }
  static float to_metres(float depth) { return depth; }
  static float invalid() { return std::nanf(""); }
};

/// A depth image in whole counts of a stated unit, as sensors and files have it. "Bit-exact" means
/// these counts. The pixels are shared, not copied, with whoever made the frame; nobody writes to
/// them.
struct DepthFrame {
  cv::Mat counts;       // CV_16UC1, 0 = no reading
  double unit = 0.001;  // metres per count

  int width() const { return counts.cols; }
  int height() const { return counts.rows; }
  bool empty() const { return counts.empty(); }
  /// Metres at (column u, row v); 0 = no reading.
  double metres(int u, int v) const { return counts.at<std::uint16_t>(v, u) * unit; }
};

/// A frame of any of REP-118's images. 16UC1 is taken as counts of 1 mm without a copy; 32FC1
/// (metres) becomes counts of the given unit, rounded; what is not finite, not positive or beyond
/// 65535 counts becomes 0. Errors: another type, an empty image, a unit that is not positive.
Result<DepthFrame> depth_frame_from_image(const cv::Mat& image, double unit_for_float);

/// A new 32FC1 image in metres with NaN where there is no reading.
cv::Mat to_float_image(const DepthFrame& frame);
/// A 16UC1 image in millimetres: the frame's own pixels if that is its unit, else a rounded copy.
cv::Mat to_millimetre_image(const DepthFrame& frame);

/// Standard deviation of a Kinect-class depth reading at z metres: 1.425e-3 z^2 (half its
/// quantisation step), plus a floor for registration and calibration.
inline double depth_sigma(double z) {
  return 1.425e-3 * z * z + 1e-3;
}

}  // namespace rprr
