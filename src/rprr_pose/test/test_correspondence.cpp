// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/correspondence.hpp"

#include <gtest/gtest.h>

#include "synthetic_views.hpp"

namespace rprr {
namespace {

TEST(Correspondence, AMeasuredPointFindsItself) {
  const DepthFrame frame = corner_view(Pose::Identity());
  for (const auto& [u, v] : {std::pair{10, 10}, {160, 120}, {319, 239}}) {
    const auto found =
        project_and_walk(kTestCamera.unproject(u, v, frame.metres(u, v)), frame, kTestCamera);
    ASSERT_EQ(found.kind, Correspondence::Kind::kFound);
    EXPECT_EQ(found.u, u);
    EXPECT_EQ(found.v, v);
  }
}

TEST(Correspondence, WalksBeyondTheFirstWindowToTheNearestPoint) {
  // A surface that recedes to the right: the nearest point lies many pixels off the projection.
  DepthFrame frame{cv::Mat(240, 320, CV_16UC1), 0.001};
  for (int u = 0; u < 320; ++u) frame.counts.col(u).setTo(1000 + 12 * u);
  const Eigen::Vector3d point = kTestCamera.unproject(160, 120, 2.75);
  const auto found = project_and_walk(point, frame, kTestCamera);
  ASSERT_EQ(found.kind, Correspondence::Kind::kFound);
  const Eigen::Vector3d first = kTestCamera.unproject(160, 120, frame.metres(160, 120));
  EXPECT_LT((found.point - point).norm(), (first - point).norm());
  EXPECT_LT(found.u, 157) << "outside of the 7x7 window around column 160";
}

TEST(Correspondence, OutOfViewBehindAndHolesAreToldApart) {
  DepthFrame frame = corner_view(Pose::Identity());
  frame.counts(cv::Rect(100, 100, 20, 20)).setTo(0);
  EXPECT_EQ(project_and_walk({5.0, 0.0, 1.0}, frame, kTestCamera).kind,
            Correspondence::Kind::kOutOfView);
  EXPECT_EQ(project_and_walk({0.0, 0.0, -1.0}, frame, kTestCamera).kind,
            Correspondence::Kind::kOutOfView);
  EXPECT_EQ(project_and_walk(kTestCamera.unproject(110, 110, 2.0), frame, kTestCamera).kind,
            Correspondence::Kind::kNoDepth);
}

}  // namespace
}  // namespace rprr
