// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "synthetic_views.hpp"

namespace rprr {

/// What a surface point of the corner looks like: waves of a hand's to an arm's length.
inline cv::Vec3b corner_colour(const Eigen::Vector3d& p, double exposure) {
  const double one =
      std::sin(9.0 * p.x() + 4.0 * p.y()) + std::sin(13.0 * p.y() - 6.0 * p.z() + 1.0);
  const double two =
      std::sin(5.0 * p.z() + 11.0 * p.x() * p.y()) + std::sin(17.0 * p.x() + 3.0 * p.z());
  const double three = std::sin(3.0 * p.x() - 7.0 * p.y() + 8.0 * p.z());
  const auto level = [&](double value) {
    return static_cast<std::uint8_t>(std::clamp(exposure * (118.0 + 45.0 * value), 0.0, 255.0));
  };
  return {level(0.8 * one + 0.3 * three), level(0.7 * one + 0.7 * two),
          level(0.8 * two - 0.4 * three)};
}

/// Depth and colour of camera b that stands where M_ab says (identity: camera a).
inline RgbdFramePtr textured_frame(const Pose& b_from_a, Stamp stamp, const std::string& robot,
                                   double exposure = 1.0) {
  auto frame = std::make_shared<RgbdFrame>(*corner_frame(b_from_a, stamp, robot));
  frame->bgr.create(kTestCamera.height, kTestCamera.width, CV_8UC3);
  const Pose a_from_b = b_from_a.inverse();
  for (int v = 0; v < kTestCamera.height; ++v) {
    for (int u = 0; u < kTestCamera.width; ++u) {
      const Eigen::Vector3d ray = a_from_b.linear() * kTestCamera.unproject(u, v, 1.0);
      const Eigen::Vector3d point =
          a_from_b.translation() + corner_depth(a_from_b.translation(), ray) * ray;
      frame->bgr.at<cv::Vec3b>(v, u) = corner_colour(point, exposure);
    }
  }
  return frame;
}

}  // namespace rprr
