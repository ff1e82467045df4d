// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/se3.hpp"

namespace rprr {

/// b_from_a, the paper's M_ab: it maps points of a's optical frame into b's, p_b = b_from_a p_a.
/// Both cameras' poses are in one world; they map points of the optical frame into the world.
inline Pose relative_pose_of(const Pose& world_from_a, const Pose& world_from_b) {
  return world_from_b.inverse() * world_from_a;
}

}  // namespace rprr
