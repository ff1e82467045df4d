// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/camera_info.hpp"

#include <gtest/gtest.h>

#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

const Camera kInfoCamera{640, 480, 500, 510, 320, 240};

sensor_msgs::CameraInfo usual_info() {
  return info_from_camera(kInfoCamera, {});
}

TEST(CameraInfo, RoundTrips) {
  const Camera camera = rounded_for_wire({640, 480, 517.3, 516.5, 318.6, 255.3});
  const Result<Camera> back = camera_from_info(info_from_camera(camera, {}));
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(camera_hash(*back), camera_hash(camera));
  EXPECT_FALSE(camera_from_info(sensor_msgs::CameraInfo())) << "an uncalibrated camera";
  EXPECT_EQ(doubt_of(usual_info()), "");
}

TEST(CameraInfo, ProjectionMatrixWinsOverTheRawOne) {
  sensor_msgs::CameraInfo info = usual_info();
  info.K[0] = 480;
  EXPECT_EQ(camera_from_info(info)->fx, 500.0);
  info.P[0] = 0;
  EXPECT_EQ(camera_from_info(info)->fx, 480.0);
}

TEST(CameraInfo, ASizeThatIsNotSaidIsTheImages) {
  sensor_msgs::CameraInfo info = usual_info();
  info.width = info.height = 0;
  const auto camera = camera_from_info(info, {640, 480});
  ASSERT_TRUE(camera) << camera.reason();
  EXPECT_EQ(camera->width, 640);
  EXPECT_EQ(camera->fx, 500.0);
}

TEST(CameraInfo, BinningAndRegionOfInterestAreApplied) {
  sensor_msgs::CameraInfo info = usual_info();
  info.binning_x = info.binning_y = 2;
  const auto binned = camera_from_info(info, {320, 240});
  ASSERT_TRUE(binned) << binned.reason();
  EXPECT_NEAR(binned->fx, 250.0, 1e-6);
  EXPECT_NEAR(binned->cy, 120.0, 1e-6);

  info.roi.x_offset = 100;
  info.roi.y_offset = 40;
  info.roi.width = 400;
  info.roi.height = 300;
  const auto both = camera_from_info(info, {200, 150});
  ASSERT_TRUE(both) << both.reason();
  EXPECT_NEAR(both->fx, 250.0, 1e-6);
  EXPECT_NEAR(both->cx, (320.0 - 100.0) / 2, 1e-6);
  EXPECT_NEAR(both->cy, (240.0 - 40.0) / 2, 1e-6);

  const auto full = camera_from_info(info, {640, 480});
  ASSERT_TRUE(full) << "a driver that says what it could do, but sends full images";
  EXPECT_EQ(full->fx, 500.0);
}

TEST(CameraInfo, AnotherSizeIsRefusedWithBothSizes) {
  const auto camera = camera_from_info(usual_info(), {1280, 720});
  ASSERT_FALSE(camera);
  EXPECT_NE(camera.reason().find("1280x720"), std::string::npos) << camera.reason();
  EXPECT_NE(camera.reason().find("640x480"), std::string::npos) << camera.reason();
}

TEST(CameraInfo, ADistortionThatWasNotTakenOutIsDoubted) {
  sensor_msgs::CameraInfo info = usual_info();
  info.D = {0.26, -0.95, 0.0, 0.0, 1.16};  // of a Kinect: dozens of pixels at the corners
  EXPECT_NE(doubt_of(info).find("unrectified"), std::string::npos) << doubt_of(info);
  info.P[0] = 480.0;  // as after rectification
  info.P[5] = 482.0;
  EXPECT_EQ(doubt_of(info), "");
  info = usual_info();
  info.D = {0.0005, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(doubt_of(info), "") << "less than anybody sees";
}

TEST(CameraInfo, ARectificationRotationIsDoubted) {
  sensor_msgs::CameraInfo info = usual_info();
  const double sine = std::sin(0.02);
  const double cosine = std::cos(0.02);
  info.R = {cosine, -sine, 0, sine, cosine, 0, 0, 0, 1};
  EXPECT_NE(doubt_of(info).find("1.1 deg"), std::string::npos) << doubt_of(info);
  info.R = {};
  EXPECT_EQ(doubt_of(info), "") << "not set";
}

TEST(CameraInfo, NothingThatCanBeSentIsMoreThanAnError) {
  sensor_msgs::CameraInfo info;
  info.width = 0xffffffff;
  info.height = 0xffffffff;
  info.binning_x = 0xffffffff;
  info.roi.width = 3;
  info.P[0] = info.P[5] = 1e300;
  info.D.assign(1000, 1e300);
  info.distortion_model = "made up";
  EXPECT_FALSE(camera_from_info(info, {640, 480}));
  EXPECT_FALSE(camera_from_info(info));
  doubt_of(info);
}

}  // namespace
}  // namespace rprr
