// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

const Camera kTestCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

/// Exact depth of the corner of a room with a box in it, in the world of camera a: analytic truth
/// that the tests below share.
inline double corner_depth(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  double nearest = 1e9;
  const auto plane = [&](const Eigen::Vector3d& normal, double distance) {
    const double along = ray.dot(normal);
    if (along <= 1e-9) return;
    const double t = (distance - origin.dot(normal)) / along;
    if (t > 0.0) nearest = std::min(nearest, t);
  };
  plane(Eigen::Vector3d(0.25, 0.0, 1.0).normalized(), 3.0);
  plane(Eigen::Vector3d(-1.0, 0.0, 0.3).normalized(), 1.6);
  plane(Eigen::Vector3d(0.1, 1.0, 0.2).normalized(), 1.1);
  // A sphere stands before the wall.
  const Eigen::Vector3d centre(0.4, 0.3, 2.0);
  const double b = ray.dot(origin - centre);
  const double c = (origin - centre).squaredNorm() - 0.35 * 0.35;
  const double under = b * b - ray.squaredNorm() * c;
  if (under > 0.0) {
    const double t = (-b - std::sqrt(under)) / ray.squaredNorm();
    if (t > 0.0) nearest = std::min(nearest, t);
  }
  return nearest;
}

/// What a camera sees that stands where M_ab says (identity: camera a), in millimetres. With noise
/// the depth is quantised in inverse depth as a Kinect does.
inline DepthFrame corner_view(const Pose& b_from_a, bool quantised = false,
                              const Camera& camera = kTestCamera) {
  DepthFrame frame{cv::Mat(camera.height, camera.width, CV_16UC1), 0.001};
  const Pose a_from_b = b_from_a.inverse();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = a_from_b.linear() * camera.unproject(u, v, 1.0);
      double z = corner_depth(a_from_b.translation(), ray);
      if (quantised) z = 1.0 / (std::round(1.0 / z / 2.85e-3) * 2.85e-3);
      frame.counts.at<std::uint16_t>(v, u) =
          z < 8.0 ? static_cast<std::uint16_t>(std::lround(z * 1000.0)) : std::uint16_t{0};
    }
  }
  return frame;
}

inline RgbdFramePtr corner_frame(const Pose& b_from_a, Stamp stamp, const std::string& robot,
                                 bool quantised = true) {
  auto frame = std::make_shared<RgbdFrame>();
  frame->stamp = stamp;
  frame->frame_id = robot + "_rgb_optical_frame";
  frame->camera = kTestCamera;
  frame->depth = corner_view(b_from_a, quantised);
  return frame;
}

/// A motion of so many metres and degrees about skew axes.
inline Pose test_motion(double metres, double degrees) {
  Twist twist;
  twist.head<3>() = metres * Eigen::Vector3d(0.7, -0.2, 0.3).normalized();
  twist.tail<3>() = degrees * M_PI / 180.0 * Eigen::Vector3d(0.2, 0.9, -0.1).normalized();
  return exp_se3(twist);
}

inline double translation_error(const Pose& estimate, const Pose& truth) {
  return (estimate.inverse().translation() - truth.inverse().translation()).norm();
}
inline double rotation_error(const Pose& estimate, const Pose& truth) {
  return rotation_angle((estimate * truth.inverse()).linear()) * 180.0 / M_PI;
}

}  // namespace rprr
