// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/warp.hpp"

namespace rprr {

/// The reference's side of the paper's "Identification of Redundant Regions in Images":
/// which blocks of the dependent's images can nobody derive from the reference's frame?
/// Keeps its warp buffers between frames; one object serves one thread.
class Predictor {
 public:
  /// B_p: the blocks of b's grid into which no pixel of a is warped. b_from_a maps points of a's
  /// optical frame into b's. Requires valid cameras; a frame that is empty or not of a_camera's
  /// size predicts nothing, so every block is in the set.
  BlockMask predict(const DepthFrame& a, const Camera& a_camera, const Camera& b_camera,
                    const Pose& b_from_a);

  /// Z_b*, as the last call of predict() left it.
  const WarpedDepth& warped() const { return warped_; }

 private:
  WarpedDepth warped_;
};

/// The blocks of a depth image (CV_32FC1, metres, 0 = nothing) that hold no depth at all.
BlockMask blocks_without_depth(const cv::Mat& metres);

}  // namespace rprr
