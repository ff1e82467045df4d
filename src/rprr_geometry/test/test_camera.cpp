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

TEST(Camera, WireRoundTripIsTheRoundedCamera) {
  ByteWriter writer;
  put_camera(writer, kCamera);
  EXPECT_EQ(writer.size(), kCameraBytes);
  ByteReader reader(writer.bytes());
  const Result<Camera> back = get_camera(reader);
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(camera_hash(*back), camera_hash(kCamera));
  EXPECT_EQ(back->fx, rounded_for_wire(kCamera).fx);
}

TEST(Camera, HashTellsCamerasApart) {
  Camera other = kCamera;
  other.cx += 0.01;
  EXPECT_NE(camera_hash(other), camera_hash(kCamera));
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
  ByteWriter writer;
  bad = kCamera;
  bad.fy = -1;
  put_camera(writer, bad);
  ByteReader reader(writer.bytes());
  EXPECT_FALSE(get_camera(reader));
  ByteReader shortened(ByteView(writer.bytes()).first(kCameraBytes - 1));
  EXPECT_FALSE(get_camera(shortened));
}

}  // namespace
}  // namespace rprr
