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

  /// motion maps points of `from`'s optical frame into `to`'s.
  PixelMap(const Camera& from, const Camera& to, const Pose& motion, double unit) {
    Eigen::Matrix3d to_k;
    to_k << to.fx, 0, to.cx, 0, to.fy, to.cy, 0, 0, 1;
    Eigen::Matrix3d from_k_inverse;
    from_k_inverse << 1 / from.fx, 0, -from.cx / from.fx, 0, 1 / from.fy, -from.cy / from.fy, 0, 0,
        1;
    map = to_k * motion.linear() * from_k_inverse * unit;
    offset = (to_k * motion.translation()).cast<float>();
    step = map.col(0).cast<float>();
  }

  Eigen::Vector3f row(int v) const { return (map.col(1) * v + map.col(2)).cast<float>(); }
};

}  // namespace rprr
