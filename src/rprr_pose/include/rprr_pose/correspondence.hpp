// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// Where a point of one camera lies in the other's depth image.
struct Correspondence {
  enum class Kind {
    kOutOfView,  // projects outside the image, or behind the camera
    kNoDepth,    // in view, but no valid depth nearby
    kFound
  };
  Kind kind = Kind::kOutOfView;
  int u = 0;  // pixel of the corresponding point
  int v = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // that pixel's point, target frame, metres
  double depth_at_projection =
      0.0;  // what the camera measured where the point projects, 0 if nothing
};

/// Project-and-walk (Benjemaa and Schmitt): from the pixel that `point` (in the target's frame)
/// projects to, step to the nearest measured point of a 7x7 neighbourhood until none is nearer.
Correspondence project_and_walk(const Eigen::Vector3d& point, const DepthFrame& target,
                                const Camera& camera);

}  // namespace rprr
