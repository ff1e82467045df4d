// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"
#include "rprr_redundancy/sparse_image.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace rprr {
namespace {

TEST(SparseImage, KeepsBlocksOfTheMaskAndNothingElse) {
  const BlockGrid grid(20, 12);  // partial blocks both ways
  BlockMask mask(grid);
  mask.set(0);
  mask.set(grid.count() - 1);
  for (const int type : {CV_8UC3, CV_16UC1, CV_32FC1}) {
    const cv::Mat image(12, 20, type, cv::Scalar::all(7));
    const auto kept = keep_blocks(image, mask);
    ASSERT_TRUE(kept) << kept.reason();
    EXPECT_EQ(kept->type(), type);
    cv::Mat flags = kept->reshape(1) != 0;
    EXPECT_EQ(cv::countNonZero(flags), (8 * 8 + 4 * 4) * image.channels());
    EXPECT_EQ(cv::countNonZero(image.reshape(1) == 7), 240 * image.channels()) << "input untouched";
  }
}

TEST(SparseImage, RefusesAnotherSize) {
  EXPECT_FALSE(keep_blocks(cv::Mat(12, 21, CV_8UC1), BlockMask(BlockGrid(20, 12))));
  EXPECT_FALSE(keep_blocks(cv::Mat(), BlockMask(BlockGrid(20, 12))));
}

}  // namespace
}  // namespace rprr
