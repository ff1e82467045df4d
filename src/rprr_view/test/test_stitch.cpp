// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"
#include "rprr_view/stitch.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

namespace rprr {
namespace {

constexpr int kStitchedWidth = 68;  // half a block at the right
constexpr int kStitchedHeight = 48;

PredictedView prediction() {
  PredictedView view;
  view.bgr = cv::Mat(kStitchedHeight, kStitchedWidth, CV_8UC3, cv::Scalar(10, 20, 30));
  view.metres = cv::Mat(kStitchedHeight, kStitchedWidth, CV_32FC1, cv::Scalar(1.23456));
  view.provenance = cv::Mat(kStitchedHeight, kStitchedWidth, CV_8UC1, cv::Scalar(kPredicted));
  const cv::Rect hole(20, 20, 10, 10);
  view.bgr(hole).setTo(0);
  view.metres(hole).setTo(0);
  view.provenance(hole).setTo(kNothing);
  return view;
}

class StitchTest : public testing::Test {
 protected:
  StitchTest()
      : mask(BlockGrid(kStitchedWidth, kStitchedHeight)),
        bgr(kStitchedHeight, kStitchedWidth, CV_8UC3) {
    depth = {cv::Mat(kStitchedHeight, kStitchedWidth, CV_16UC1), 0.0002};
    std::mt19937 random(5);
    for (int i = 0; i < kStitchedHeight * kStitchedWidth; ++i) {
      depth.counts.ptr<std::uint16_t>()[i] = static_cast<std::uint16_t>(random());
      bgr.ptr<cv::Vec3b>()[i] = {static_cast<std::uint8_t>(random()), 0, 255};
    }
    mask.set(0);
    mask.set(mask.grid().count() - 1);
  }
  BlockMask mask;
  cv::Mat bgr;
  DepthFrame depth;
};

TEST_F(StitchTest, ReceivedBlocksAreExactAndTheRestIsPredicted) {
  const auto view = Stitcher().stitch(prediction(), bgr, depth, mask, mask);
  ASSERT_TRUE(view) << view.reason();
  EXPECT_EQ(view->depth.unit, 0.0002);
  for (int block = 0; block < mask.grid().count(); ++block) {
    const cv::Rect rect = mask.grid().rect(block);
    if (!mask[block]) continue;
    EXPECT_EQ(cv::norm(view->bgr(rect), bgr(rect), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(view->depth.counts(rect), depth.counts(rect), cv::NORM_INF), 0);
    EXPECT_EQ(cv::countNonZero(view->provenance(rect) != kReceived), 0);
  }
  EXPECT_EQ(view->depth.counts.at<std::uint16_t>(10, 10), 6173) << "1.23456 m in 0.2 mm";
  EXPECT_EQ(view->bgr.at<cv::Vec3b>(10, 10), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(view->depth.counts.at<std::uint16_t>(25, 25), 0) << "no depth is invented";
  const double pixels = kStitchedWidth * kStitchedHeight;
  EXPECT_NEAR(view->share_received, (64 + 32) / pixels, 1e-9);
  EXPECT_NEAR(view->share_predicted, (pixels - 64 - 32 - 100) / pixels, 1e-9);
}

TEST_F(StitchTest, BlocksOfColourOnlyKeepThePredictedDepth) {
  BlockMask with_depth(mask.grid());
  with_depth.set(mask.grid().count() - 1);
  const auto view = Stitcher().stitch(prediction(), bgr, depth, mask, with_depth);
  ASSERT_TRUE(view) << view.reason();
  const cv::Rect colour_only = mask.grid().rect(0);
  EXPECT_EQ(cv::norm(view->bgr(colour_only), bgr(colour_only), cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(view->depth.counts(colour_only) != 6173), 0) << "1.23456 m";
  EXPECT_EQ(cv::countNonZero(view->provenance(colour_only) != kReceivedColour), 0);
  const cv::Rect both = mask.grid().rect(mask.grid().count() - 1);
  EXPECT_EQ(cv::norm(view->depth.counts(both), depth.counts(both), cv::NORM_INF), 0);
}

TEST_F(StitchTest, UnknownPixelsAreFilledOrBlack) {
  const auto smooth =
      Stitcher({UnknownFill::kSmooth, 0}).stitch(prediction(), bgr, depth, mask, mask);
  EXPECT_EQ(smooth->bgr.at<cv::Vec3b>(25, 25), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(smooth->provenance.at<std::uint8_t>(25, 25), kFilled);
  const auto black =
      Stitcher({UnknownFill::kBlack, 0}).stitch(prediction(), bgr, depth, mask, mask);
  EXPECT_EQ(black->bgr.at<cv::Vec3b>(25, 25), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(black->provenance.at<std::uint8_t>(25, 25), kNothing);
}

TEST_F(StitchTest, DepthBeyondTheUnitIsNoDepth) {
  PredictedView far = prediction();
  far.metres.setTo(13.2);  // 66000 counts of 0.2 mm
  const auto view = Stitcher().stitch(far, bgr, depth, mask, mask);
  EXPECT_EQ(view->depth.counts.at<std::uint16_t>(10, 10), 0);
}

TEST_F(StitchTest, TheResultOwnsItsPixels) {
  const PredictedView predicted = prediction();
  const auto view = Stitcher().stitch(predicted, bgr, depth, mask, mask);
  const cv::Mat before = view->bgr.clone();
  cv::Mat(predicted.bgr).setTo(0);
  bgr.setTo(0);
  EXPECT_EQ(cv::norm(view->bgr, before, cv::NORM_INF), 0);
}

TEST_F(StitchTest, RefusesSizesThatDiffer) {
  EXPECT_FALSE(Stitcher().stitch(prediction(), cv::Mat(4, 4, CV_8UC3), depth, mask, mask));
  EXPECT_FALSE(Stitcher().stitch(prediction(), bgr, {}, mask, mask));
  EXPECT_FALSE(Stitcher().stitch(prediction(), bgr, depth, BlockMask(BlockGrid(64, 48)),
                                 BlockMask(BlockGrid(64, 48))));
  EXPECT_FALSE(Stitcher().stitch(PredictedView(), bgr, depth, mask, mask));
  EXPECT_FALSE(Stitcher().stitch(PredictedView(), cv::Mat(), {}, BlockMask(), BlockMask()));
}

}  // namespace
}  // namespace rprr
