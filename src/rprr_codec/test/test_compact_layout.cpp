// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/compact_layout.hpp"

#include <gtest/gtest.h>

#include "synthetic.hpp"

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
  const BlockGrid grid(640, 480);
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const BlockMask mask = synthetic::some_blocks(grid, 0.001 * seed, seed);
    const cv::Size size = CompactLayout(mask).size();
    EXPECT_LE(size.width, 640);
    EXPECT_LE(size.height, 480);
    EXPECT_GE(size.area(), mask.count() * kBlockSide * kBlockSide);
    EXPECT_EQ(size.width % kBlockSide + size.height % kBlockSide, 0);
  }
}

TEST(CompactLayout, NoBlockTakesNoImage) {
  EXPECT_EQ(CompactLayout(BlockMask(BlockGrid(64, 48))).size().area(), 0);
}

}  // namespace
}  // namespace rprr
