// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

const Camera kCamera{640, 480, 525.3, 524.7, 319.1, 241.9};

TEST(CameraWire, RoundTripIsTheRoundedCamera) {
  ByteWriter writer;
  put_camera(writer, kCamera);
  EXPECT_EQ(writer.size(), kCameraBytes);
  ByteReader reader(writer.bytes());
  const Result<Camera> back = get_camera(reader);
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(camera_hash(*back), camera_hash(kCamera));
  EXPECT_EQ(back->fx, rounded_for_wire(kCamera).fx);
}

TEST(CameraWire, HashTellsCamerasApart) {
  Camera other = kCamera;
  other.cx += 0.01;
  EXPECT_NE(camera_hash(other), camera_hash(kCamera));
}

TEST(CameraWire, ImpossibleIntrinsicsAreRefused) {
  ByteWriter writer;
  Camera bad = kCamera;
  bad.fy = -1;
  put_camera(writer, bad);
  ByteReader reader(writer.bytes());
  EXPECT_FALSE(get_camera(reader));
  ByteReader shortened(ByteView(writer.bytes()).first(kCameraBytes - 1));
  EXPECT_FALSE(get_camera(shortened));
}

}  // namespace
}  // namespace rprr
