// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rprr_geometry/se3.hpp"
#include "rprr_pose/coarse_match.hpp"

namespace rprr {

/// How far the starting poses of a search reach.
struct StartRange {
  double yaw = 72.0;           ///< either way [degrees]
  double pitch = 36.0;         ///< either way [degrees]
  double roll = 24.0;          ///< either way [degrees]
  double step = 8.0;           ///< between starting rotations [degrees]
  std::size_t rotations = 24;  ///< distinct rotations that the first stage keeps
  std::size_t starts = 60;     ///< poses that the second stage keeps
};

/// Starting poses of the search (fixed_from_moving), the most promising first. Every rotation
/// of a grid, with steps forward and back, is judged on very coarse views by how colours correlate
/// and depths agree where the views then overlap. The best distinct ones are then turned about the
/// middle of the scene, since a shift of the image may be a turn of the camera or a step aside, and
/// the best of those are improved step by step under the same judgement.
std::vector<Pose> find_starts(const CoarseMatch& match, const StartRange& range);

/// How far along `direction` (unit length; metres) from a motion the views match once more: the
/// best few local maxima, at least 0.3 m away.
std::vector<double> matches_along(const CoarseMatch& match, const Pose& from,
                                  const Twist& direction);

}  // namespace rprr
