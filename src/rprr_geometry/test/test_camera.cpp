// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/camera.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rprr {
namespace {

const Camera kCamera{640, 480, 525.3, 524.7, 319.1, 241.9};

TEST(Camera, ProjectUndoesUnproject) {
  for (const double u : {0.0, 100.5, 639.0}) {
    for (const double v : {0.0, 479.0}) {
      const Eigen::Vector2d pixel = kCamera.project(kCamera.unproject(u, v, 2.3));
      EXPECT_NEAR(pixel.x(), u, 1e-9);
      EXPECT_NEAR(pixel.y(), v, 1e-9);
    }
  }
}

TEST(Camera, AxesFollowRep103) {
  EXPECT_GT(kCamera.unproject(600, 240, 1.0).x(), 0.0) << "x points right";
  EXPECT_GT(kCamera.unproject(320, 470, 1.0).y(), 0.0) << "y points down";
}

TEST(Camera, ImpossibleIntrinsicsAreRefused) {
  Camera bad = kCamera;
  bad.fx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bad.valid());
  bad = kCamera;
  bad.width = 0;
  EXPECT_FALSE(bad.valid());
  bad = kCamera;
  bad.height = kMaxImageSide + 1;
  EXPECT_FALSE(bad.valid());
}

}  // namespace
}  // namespace rprr
