// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

struct ValidationOptions {
  /// A block is in B_v once this many of its valid pixels leave a's view. The paper: 1.
  int min_pixels = 1;
};

/// The dependent's side of the paper's "Identification of Redundant Regions in Images": surfaces
/// that b sees and that lie outside of a's field of view (paper, Fig. occlusion). a's prediction
/// may cover such blocks wrongly, with what lies behind.
///
/// The paper's test knows a's field of view only. A surface of b that falls inside a's image but
/// behind something nearer, which a saw instead, is not found here.
///
/// Keeps its buffers between frames; one object serves one thread.
class Validator {
 public:
  explicit Validator(ValidationOptions options = {}) : options_(options) {}

  /// B_v: the blocks of b's grid with valid pixels whose warp by M_ab^-1 leaves a's image or lands
  /// behind a's camera. b_from_a maps points of a's optical frame into b's. Requires valid cameras;
  /// a frame that is empty or not of b_camera's size yields the empty set.
  BlockMask validate(const DepthFrame& b, const Camera& b_camera, const Camera& a_camera,
                     const Pose& b_from_a);

 private:
  ValidationOptions options_;
  std::vector<std::uint8_t> outside_;  // of one row of pixels
  std::vector<int> outside_in_block_;  // of one row of blocks
};

}  // namespace rprr
