// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

/// A depth image as another camera would see it: the paper's Z_b*.
struct WarpedDepth {
  cv::Mat metres;  // CV_32FC1, target camera's size; 0 where nothing was warped to
  cv::Mat source;  // CV_32SC1, v * width + u of the pixel in the source image; -1 where none
};

/// Which pixels of the target a pixel of the source covers.
enum class Footprint {
  kNearest,  // one: the paper's
  kSurface,  // those within half a pixel of the source, as large as it appears in the target:
             // leaves few cracks where the target is nearer to the surface
};

/// Paper eq. 1 for every valid pixel; of those that cover a target pixel the closest wins. Both
/// cameras' intrinsics are used. target_from_source maps points of the source's optical frame into
/// the target's. `out` is reused between calls: no allocation while sizes stay the same. The frame
/// must have the source camera's size.
void warp_depth(const DepthFrame& source, const Camera& source_camera, const Camera& target_camera,
                const Pose& target_from_source, WarpedDepth& out,
                Footprint footprint = Footprint::kNearest);

}  // namespace rprr
