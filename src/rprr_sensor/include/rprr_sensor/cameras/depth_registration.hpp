// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/warp.hpp"

namespace rprr {

/// Brings depth from the depth camera's image into that of the colour camera beside it.
class DepthRegistration {
 public:
  /// colour_from_depth maps points of the depth camera's optical frame into the colour camera's.
  DepthRegistration(const Camera& depth_camera, const Camera& colour_camera,
                    const Pose& colour_from_depth)
      : depth_camera_(depth_camera),
        colour_camera_(colour_camera),
        colour_from_depth_(colour_from_depth) {}

  /// A new frame of the colour camera's size, in counts of 1 mm; where several surfaces fall on a
  /// pixel the nearest stays, where none does there is no reading. `depth` has the depth camera's
  /// size.
  DepthFrame apply(const DepthFrame& depth);

 private:
  Camera depth_camera_;
  Camera colour_camera_;
  Pose colour_from_depth_;
  WarpedDepth warped_;  // kept, so that nothing is allocated for each frame
};

}  // namespace rprr
