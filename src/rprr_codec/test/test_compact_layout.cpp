// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/compact_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_synthetic/coded_images.hpp"

namespace rprr {
namespace {

TEST(CompactLayout, GatheredBlocksAreScatteredBackToWhereTheyWere) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{640, 480}, {541, 363}, {9, 1}, {1, 9}, {17, 23}}) {
    const cv::Mat image = synthetic::colourful(width, height);
    for (const double share : {0.02, 0.3, 1.0}) {
      const BlockMask mask = synthetic::some_blocks(BlockGrid(width, height), share);
      const CompactLayout layout(mask);
      EXPECT_EQ(layout.used().count(), mask.count());
      if (mask.count() == 0) continue;
      cv::Mat compact;
      layout.gather(image, compact);
      ASSERT_EQ(compact.size(), layout.size());
      cv::Mat back = cv::Mat::zeros(image.size(), CV_8UC3);
      layout.scatter(compact, back);
      EXPECT_TRUE(synthetic::same(back, synthetic::only(image, mask)));
    }
  }
}

TEST(CompactLayout, IsNoLargerThanTheImageAndNoSmallerThanTheBlocks) {
  for (const BlockGrid& grid : {BlockGrid(640, 480), BlockGrid(649, 481), BlockGrid(8192, 64)}) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      const BlockMask mask = synthetic::some_blocks(grid, 0.001 * seed * seed, seed);
      const cv::Size size = CompactLayout(mask).size();
      EXPECT_LE(size.area(), grid.count() * kBlockSide * kBlockSide);
      EXPECT_GE(size.area(), mask.count() * kBlockSide * kBlockSide);
      EXPECT_LE(std::max(size.width, size.height), kMaxImageSide);
      EXPECT_EQ(size.width % kBlockSide + size.height % kBlockSide, 0);
    }
  }
}

TEST(CompactLayout, FarRegionsComeTogether) {
  BlockMask mask(BlockGrid(640, 480));
  for (int i = 0; i < 20; ++i) mask.set(mask.grid().index(4 * i, 3 * i));
  EXPECT_LE(CompactLayout(mask).size().area(), 20 * 16 * 16 * 2) << "16x16 pixels each";
}

TEST(CompactLayout, OneRegionStaysAsItIs) {
  const cv::Mat image = synthetic::colourful(640, 480);
  BlockMask mask(BlockGrid(640, 480));
  for (int row = 10; row < 20; ++row) {
    for (int column = 30; column < 50; ++column) mask.set(mask.grid().index(column, row));
  }
  const CompactLayout layout(mask);
  ASSERT_EQ(layout.size(), cv::Size(160, 80));
  cv::Mat compact;
  layout.gather(image, compact);
  EXPECT_TRUE(synthetic::same(compact, image(cv::Rect(240, 80, 160, 80))));
}

// Shapes that pack badly: rings within rings, and lines across all of it.
TEST(CompactLayout, NestedRegionsFit) {
  for (const int side : {120, 4096}) {
    const BlockGrid grid(side, side);
    BlockMask mask(grid);
    for (int block = 0; block < grid.count(); ++block) {
      const int column = block % grid.columns;
      const int row = block / grid.columns;
      const int rim = std::min({column, row, grid.columns - 1 - column, grid.rows - 1 - row});
      mask.set(block, rim % 3 == 0);
    }
    EXPECT_LE(CompactLayout(mask).size().area(), side * side);
  }
}

TEST(CompactLayout, NoBlockTakesNoImage) {
  EXPECT_EQ(CompactLayout(BlockMask(BlockGrid(64, 48))).size().area(), 0);
}

}  // namespace
}  // namespace rprr
