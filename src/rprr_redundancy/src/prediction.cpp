// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/prediction.hpp"
#include "rprr_geometry/block_mask.hpp"

#include <algorithm>

namespace rprr {

BlockMask blocks_without_depth(const cv::Mat& metres) {
  const BlockGrid grid(metres.cols, metres.rows);
  BlockMask mask(grid, true);
  for (int v = 0; v < metres.rows; ++v) {
    const auto* row = metres.ptr<float>(v);
    for (int column = 0; column < grid.columns; ++column) {
      const int block = grid.index(column, v / kBlockSide);
      if (!mask[block]) continue;
      const int begin = column * kBlockSide;
      const int end = std::min(begin + kBlockSide, metres.cols);
      float farthest = 0.0f;
      for (int u = begin; u < end; ++u) farthest = std::max(farthest, row[u]);
      if (farthest > 0.0f) mask.set(block, false);
    }
  }
  return mask;
}

BlockMask Predictor::predict(const DepthFrame& a, const Camera& a_camera, const Camera& b_camera,
                             const Pose& b_from_a) {
  if (a.empty() || a.width() != a_camera.width || a.height() != a_camera.height) {
    return BlockMask(BlockGrid(b_camera.width, b_camera.height), true);
  }
  warp_depth(a, a_camera, b_camera, b_from_a, warped_);
  return blocks_without_depth(warped_.metres);
}

}  // namespace rprr
