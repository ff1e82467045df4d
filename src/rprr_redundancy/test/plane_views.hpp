// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

inline const Camera kVga{640, 480, 528, 528, 319.5, 239.5};
inline const Camera kPartial{540, 360, 460, 460, 269.5, 179.5};  // 540 = 67 blocks and a half

/// A wall across the optical axis that fills the image.
inline DepthFrame plane(const Camera& camera, int millimetres) {
  return {cv::Mat(camera.height, camera.width, CV_16UC1, cv::Scalar(millimetres)), 0.001};
}

inline Pose shift(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, z;
  return pose;
}

}  // namespace rprr
