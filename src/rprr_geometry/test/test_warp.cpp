// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/warp.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace rprr {
namespace {

const Camera kA{64, 48, 60, 60, 31.5, 23.5};

DepthFrame plane(std::uint16_t millimetres) {
  return {cv::Mat(48, 64, CV_16UC1, cv::Scalar(millimetres)), 0.001};
}

TEST(Warp, IdentityReproducesTheFrame) {
  DepthFrame frame = plane(2000);
  frame.counts.at<std::uint16_t>(10, 20) = 0;
  WarpedDepth out;
  warp_depth(frame, kA, kA, Pose::Identity(), out);
  EXPECT_EQ(out.metres.at<float>(10, 20), 0.0f);
  EXPECT_EQ(out.source.at<int>(10, 20), -1);
  EXPECT_NEAR(out.metres.at<float>(5, 6), 2.0f, 1e-5f);
  EXPECT_EQ(out.source.at<int>(5, 6), 5 * 64 + 6);
}

// b stands 0.2 m to the right of a: p_b = p_a - (0.2, 0, 0), so things move left in b's image by
// fx * 0.2 / z pixels.
TEST(Warp, KnownMotionMovesPixelsTheRightWay) {
  Pose b_from_a = Pose::Identity();
  b_from_a.translation().x() = -0.2;
  WarpedDepth out;
  warp_depth(plane(2000), kA, kA, b_from_a, out);
  EXPECT_EQ(out.source.at<int>(20, 10), 20 * 64 + 16);
  EXPECT_EQ(out.source.at<int>(20, 63), -1) << "b sees beyond a's right edge";
}

TEST(Warp, TheNearestSurfaceWins) {
  DepthFrame frame = plane(2000);
  frame.counts(cv::Rect(30, 0, 4, 48)).setTo(1000);
  Pose b_from_a = Pose::Identity();
  b_from_a.translation().x() = -0.2;
  WarpedDepth out;
  warp_depth(frame, kA, kA, b_from_a, out);
  EXPECT_NEAR(out.metres.at<float>(20, 18), 1.0f, 1e-5f) << "the bar moved by 12 pixels";
}

TEST(Warp, BothCamerasIntrinsicsAreUsed) {
  const Camera b{128, 96, 120, 120, 63.5, 47.5};
  WarpedDepth out;
  warp_depth(plane(2000), kA, b, Pose::Identity(), out);
  EXPECT_EQ(out.metres.cols, 128);
  // Pixel (31, 23) of a lies half a pixel off its centre, so one pixel off b's: (62.5, 46.5).
  EXPECT_EQ(out.source.at<int>(47, 63), 23 * 64 + 31);
}

TEST(Warp, PointsBehindTheTargetAreDropped) {
  Pose b_from_a = Pose::Identity();
  b_from_a.translation().z() = -3.0;
  WarpedDepth out;
  warp_depth(plane(2000), kA, kA, b_from_a, out);
  EXPECT_EQ(cv::countNonZero(out.metres), 0);
}

TEST(Warp, TheUnitOfTheFrameCounts) {
  DepthFrame frame = plane(10000);
  frame.unit = 0.0002;
  WarpedDepth out;
  warp_depth(frame, kA, kA, Pose::Identity(), out);
  EXPECT_NEAR(out.metres.at<float>(20, 20), 2.0f, 1e-5f);
}

}  // namespace
}  // namespace rprr
