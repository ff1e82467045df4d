// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/sampling.hpp"

#include <gtest/gtest.h>

#include <set>

#include "synthetic_views.hpp"

namespace rprr {
namespace {

TEST(Sampling, PointsAreValidPixelsOfTheFrameAndSpreadOverIt) {
  const DepthFrame frame = corner_view(Pose::Identity());
  const auto points = sample_points(frame, kTestCamera, kSampleCount, 7);
  ASSERT_EQ(points.size(), 250u);
  std::set<int> quarters;
  for (const SamplePoint& point : points) {
    EXPECT_EQ(point.counts, frame.counts.at<std::uint16_t>(point.row, point.column));
    EXPECT_NE(point.counts, 0);
    quarters.insert(point.column / 40 * 10 + point.row / 40);
  }
  EXPECT_GT(quarters.size(), 40u) << "of 48 fields of 40x40 pixels";
}

TEST(Sampling, OtherSeedsGiveOtherPoints) {
  const DepthFrame frame = corner_view(Pose::Identity());
  const auto first = sample_points(frame, kTestCamera, 50, 1);
  const auto again = sample_points(frame, kTestCamera, 50, 1);
  const auto other = sample_points(frame, kTestCamera, 50, 2);
  int same = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].column, again[i].column);
    same += first[i].column == other[i].column && first[i].row == other[i].row ? 1 : 0;
  }
  EXPECT_LT(same, 5);
}

TEST(Sampling, AnEmptyFrameGivesNothingAndAHoleyOneLess) {
  DepthFrame frame{cv::Mat(240, 320, CV_16UC1, cv::Scalar(0)), 0.001};
  EXPECT_TRUE(sample_points(frame, kTestCamera, kSampleCount, 1).empty());
  frame.counts(cv::Rect(0, 0, 30, 30)).setTo(1500);
  const auto few = sample_points(frame, kTestCamera, kSampleCount, 1);
  EXPECT_GT(few.size(), 5u);
  EXPECT_LT(few.size(), 250u);
}

}  // namespace
}  // namespace rprr
