// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/frustum.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

const Camera kCamera{640, 480, 525.0, 520.0, 310.0, 250.0};

TEST(Frustum, LinesComeInPairsAndStayWithinTheLength) {
  const auto ends = frustum_lines(kCamera, 0.5);
  ASSERT_EQ(ends.size(), 2u * (4 + 4 + 2));
  for (const auto& end : ends) {
    EXPECT_GE(end.z(), 0.0);
    EXPECT_LE(end.z(), 0.5 + 1e-12);
  }
}

TEST(Frustum, ItsRimIsTheImagesRim) {
  const auto ends = frustum_lines(kCamera, 2.0);
  const Eigen::Vector2d upper_left = kCamera.project(ends[1]);
  EXPECT_TRUE(ends[0].isZero());
  EXPECT_NEAR(upper_left.x(), -0.5, 1e-9);
  EXPECT_NEAR(upper_left.y(), -0.5, 1e-9);
  const Eigen::Vector2d lower_right = kCamera.project(ends[9]);
  EXPECT_NEAR(lower_right.x(), 639.5, 1e-9);
  EXPECT_NEAR(lower_right.y(), 479.5, 1e-9);
}

TEST(Frustum, TheRoofIsAboveTheImage) {
  const auto ends = frustum_lines(kCamera, 1.0);
  EXPECT_LT(ends.back().y(), ends[1].y()) << "y points down";
  EXPECT_EQ(ends[ends.size() - 1], ends[ends.size() - 3]);
}

}  // namespace
}  // namespace rprr
