// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rprr_geometry/se3.hpp"
#include "rprr_pose/preview_view.hpp"

namespace rprr {

/// How far a search for starting rotations goes, degrees either way.
struct StartRange {
  double yaw = 72.0;
  double pitch = 36.0;
  double roll = 24.0;
  double step = 6.0;
  std::size_t rotations = 14;  // distinct ones kept
};

/// Motions from the moving to the fixed view worth trying. Every rotation of a grid is judged on
/// very coarse views by how colours correlate and depths agree where the views then overlap; from
/// the best distinct ones come starts that map the middle of the scene to the same place but turn
/// about it by different amounts, since a shift of the image may be a turn of the camera or a step
/// aside. Best rotation first.
std::vector<Pose> find_starts(const PreviewView& moving_coarse, const PreviewView& fixed_coarse,
                              const StartRange& range);

}  // namespace rprr
