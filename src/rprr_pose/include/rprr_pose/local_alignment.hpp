// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_pose/icp_bd.hpp"

namespace rprr {

/// A first estimate that costs no message: b's points with their normals, once they are at a,
/// aligned to Z_a alone (the second sum of paper eq. 2) from many starting rotations. Each start is
/// iterated on a part of the points; the best few are refined on all of them. A start counts by its
/// points that agree with Z_a less twice those that lie in seen free space.
struct LocalAlignment {
  Pose b_from_a = Pose::Identity();  // the paper's M_ab
  double score = 0.0;                // (consistent - 2 violating) / points, at most 1
};

LocalAlignment align_locally(const SampledSurface& b_points, const DepthFrame& a_depth,
                             const Camera& a_camera);

}  // namespace rprr
