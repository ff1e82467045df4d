// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"
#include "rprr_redundancy/prediction.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "plane_views.hpp"

namespace rprr {
namespace {

class PredictionOfBothSizes : public testing::TestWithParam<Camera> {};
INSTANTIATE_TEST_SUITE_P(Sizes, PredictionOfBothSizes, testing::Values(kVga, kPartial));

TEST_P(PredictionOfBothSizes, IdentityAsksOnlyForTheHolesOfTheReference) {
  const Camera camera = GetParam();
  const BlockGrid grid(camera.width, camera.height);
  DepthFrame a = plane(camera, 2000);
  const int last = grid.count() - 1;
  for (const int block : {0, 77, last}) a.counts(grid.rect(block)).setTo(0);
  a.counts.at<std::uint16_t>(100, 100) = 0;  // a single pixel is no reason to send a block
  const BlockMask mask = Predictor().predict(a, camera, camera, Pose::Identity());
  EXPECT_EQ(mask.count(), 3);
  EXPECT_TRUE(mask[0] && mask[77] && mask[last]);
}

// b stands to the right of a by 32 pixels of disparity: it sees four columns of blocks more.
TEST(Prediction, TranslationAsksForTheBorderThatTheReferenceDoesNotSee) {
  const BlockGrid grid(kVga.width, kVga.height);
  const Pose b_from_a = shift(-32.0 * 2.0 / 528.0, 0, 0);
  const BlockMask mask = Predictor().predict(plane(kVga, 2000), kVga, kVga, b_from_a);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      EXPECT_EQ(mask[grid.index(column, row)], column >= 76) << column << ", " << row;
    }
  }
}

TEST(Prediction, DisocclusionIsAskedFor) {
  DepthFrame a = plane(kVga, 3000);
  a.counts(cv::Rect(300, 0, 40, 480)).setTo(1000);
  const Pose b_from_a = shift(-0.2, 0, 0);  // bar moves 105.6 pixels, background 35.2
  const BlockMask mask = Predictor().predict(a, kVga, kVga, b_from_a);
  // Shadow of the bar: columns 304.8 - ... the background from 300 - 35.2 to 340 - 35.2 was hidden.
  const BlockGrid grid(kVga.width, kVga.height);
  EXPECT_TRUE(mask[grid.index_of_pixel(284, 240)]) << "uncovered background";
  EXPECT_FALSE(mask[grid.index_of_pixel(212, 240)]) << "the bar";
  EXPECT_FALSE(mask[grid.index_of_pixel(400, 240)]) << "seen background";
}

TEST(Prediction, IntrinsicsOfBothCamerasCount) {
  // b looks through a lens of twice the angle: a covers the middle half of its image each way.
  const Camera wide{640, 480, 264, 264, 319.5, 239.5};
  const BlockMask mask = Predictor().predict(plane(kVga, 2000), kVga, wide, Pose::Identity());
  const BlockGrid grid(640, 480);
  EXPECT_EQ(mask.count(), grid.count() - 40 * 30);
  EXPECT_FALSE(mask[grid.index_of_pixel(320, 240)]);
  EXPECT_TRUE(mask[grid.index_of_pixel(150, 240)]);
  const BlockMask other = Predictor().predict(plane(kVga, 2000), kVga, kPartial, Pose::Identity());
  EXPECT_EQ(other.grid().width, 540);
  EXPECT_EQ(other.count(), 0) << "narrower than a";
}

TEST(Prediction, ReferenceBehindOrWithoutDepthPredictsNothing) {
  const int all = BlockGrid(640, 480).count();
  Predictor predictor;
  EXPECT_EQ(predictor.predict(plane(kVga, 0), kVga, kVga, Pose::Identity()).count(), all);
  EXPECT_EQ(predictor.predict(plane(kVga, 2000), kVga, kVga, shift(0, 0, -3)).count(), all);
  EXPECT_EQ(predictor.predict({}, kVga, kVga, Pose::Identity()).count(), all);
  EXPECT_EQ(predictor.predict(plane(kPartial, 2000), kVga, kVga, Pose::Identity()).count(), all)
      << "a frame of another size than its camera";
}

}  // namespace
}  // namespace rprr
