// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

/// A point nearer than this to a camera's plane (metres), or behind it, is not seen by it.
constexpr float kNearestDepth = 0.05f;

/// Paper eq. 1 for whole images: K_to M (z K_from^-1 [u v 1]) = z (map [u v 1]) + offset is the
/// homogeneous pixel in the target camera, and its third component the depth there. Along a row it
/// is z (row(v) + u step) + offset: what hot loops use. z is in units of `unit` metres.
struct PixelMap {
  Eigen::Matrix3d map;
  Eigen::Vector3f offset;
  Eigen::Vector3f step;

  /// target_from_source maps points of the source's optical frame into the target's.
  PixelMap(const Camera& source, const Camera& target, const Pose& target_from_source,
           double unit) {
    Eigen::Matrix3d target_k;
    target_k << target.fx, 0, target.cx, 0, target.fy, target.cy, 0, 0, 1;
    Eigen::Matrix3d source_k_inverse;
    source_k_inverse << 1 / source.fx, 0, -source.cx / source.fx, 0, 1 / source.fy,
        -source.cy / source.fy, 0, 0, 1;
    map = target_k * target_from_source.linear() * source_k_inverse * unit;
    offset = (target_k * target_from_source.translation()).cast<float>();
    step = map.col(0).cast<float>();
  }

  Eigen::Vector3f row(int v) const { return (map.col(1) * v + map.col(2)).cast<float>(); }
};

}  // namespace rprr
