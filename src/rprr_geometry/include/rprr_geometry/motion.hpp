// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/se3.hpp"

namespace rprr {

/// M_ab (maps points of a's optical frame into b's: p_b = M_ab p_a) from both cameras' poses in one
/// world, which map points of the optical frame into the world.
inline Pose relative_motion(const Pose& world_from_a, const Pose& world_from_b) {
  return world_from_b.inverse() * world_from_a;
}

}  // namespace rprr
