// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "rprr_geometry/se3.hpp"

namespace rprr {

/// Pose of an optical frame (x right, y down, z forward) at `eye` that looks along `yaw` (from the
/// world's x towards y) and `pitch` (up), turned about its axis by `roll`. World z is up; radians.
Pose look_along(const Eigen::Vector3d& eye, double yaw, double pitch, double roll);

/// One camera walking round the middle of make_room() and looking at what stands along the walls:
/// about 0.06 m and 4 deg between two frames. world_from_camera of each frame.
std::vector<Pose> single_walk(int frames, std::uint32_t seed);

/// Where the two cameras of a pair are, world_from_camera.
struct PairPose {
  Pose a = Pose::Identity();
  Pose b = Pose::Identity();
};

/// Two cameras walking side by side in make_room(): mostly 0.05 to 0.25 m and 3 to 10 deg apart,
/// with an excursion to about 20 deg once in ten frames.
std::vector<PairPose> pair_walk(int frames, std::uint32_t seed);

}  // namespace rprr
