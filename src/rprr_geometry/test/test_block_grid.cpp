// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_grid.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rprr {
namespace {

TEST(BlockGrid, VgaHasTheFourThousandEightHundredBlocksOfThePaper) {
  EXPECT_EQ(BlockGrid(640, 480).count(), 4800);
}

TEST(BlockGrid, BlocksTileAnySizeExactlyOnce) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{640, 480}, {540, 360}, {1, 1}, {9, 7}, {8, 17}}) {
    const BlockGrid grid(width, height);
    std::vector<int> seen(static_cast<std::size_t>(width * height), 0);
    for (int block = 0; block < grid.count(); ++block) {
      const cv::Rect rect = grid.rect(block);
      for (int v = rect.y; v < rect.y + rect.height; ++v) {
        for (int u = rect.x; u < rect.x + rect.width; ++u) {
          EXPECT_EQ(grid.index_of_pixel(u, v), block);
          ++seen[static_cast<std::size_t>(v * width + u)];
        }
      }
    }
    for (const int times : seen) ASSERT_EQ(times, 1) << width << "x" << height;
  }
}

}  // namespace
}  // namespace rprr
