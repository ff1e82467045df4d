// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_grid.hpp"

#include <algorithm>

namespace rprr {

cv::Rect BlockGrid::rect(int block) const {
  const int u = block % columns * kBlockSide;
  const int v = block / columns * kBlockSide;
  return {u, v, std::min(kBlockSide, width - u), std::min(kBlockSide, height - v)};
}

}  // namespace rprr
