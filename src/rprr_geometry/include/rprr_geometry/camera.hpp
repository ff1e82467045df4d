// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace rprr {

/// The largest image side that any part of RPRR accepts.
constexpr int kMaxImageSide = 8192;
/// Images of more pixels are refused unless an option says otherwise, by robots and station alike.
constexpr std::size_t kLargestImage = 1920 * 1200;

/// A pinhole camera without distortion (images are rectified before they come here). Optical frame
/// of REP-103: x right, y down, z forward. Pixel centres have integer coordinates.
struct Camera {
  int width = 0;    // [px]
  int height = 0;   // [px]
  double fx = 0.0;  // focal lengths, pixels
  double fy = 0.0;
  double cx = 0.0;  // principal point, pixels
  double cy = 0.0;

  /// Sizes within kMaxImageSide, focal lengths positive, everything finite.
  bool valid() const;

  /// Point at pixel (u, v) and depth z (metres along the optical axis).
  Eigen::Vector3d unproject(double u, double v, double z) const {
    return {(u - cx) / fx * z, (v - cy) / fy * z, z};
  }
  /// Pixel coordinates of a point with z > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }
  bool contains(double u, double v) const {
    return u >= -0.5 && v >= -0.5 && u < width - 0.5 && v < height - 0.5;
  }
};

}  // namespace rprr
