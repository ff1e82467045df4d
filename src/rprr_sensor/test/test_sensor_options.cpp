// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "cameras/camera_options.hpp"
#include "cameras/relay_options.hpp"
#include "recordings/player_options.hpp"
#include "rprr_synthetic/option_check.hpp"

namespace rprr {
namespace {

TEST(CameraOptions, HoldWhatHoldsForEveryTableAndAreDocumented) {
  CameraOptions options;
  const OptionTable table = options_of(options);
  check_options(table);
  check_document(table, "Private parameters of rprr_sensor/Freenect and rprr_sensor/OpenNI2.",
                 RPRR_CONFIG "/rgbd_camera.yaml");
}

TEST(CameraOptions, TheDepthCameraIsWhereTheyPutIt) {
  CameraOptions options;
  options.depth_to_colour_rotation = {0.0, 0.0, 1.5707963267948966};
  const Eigen::Vector3d moved = colour_from_depth(options) * Eigen::Vector3d(1.0, 0.0, 2.0);
  EXPECT_LT((moved - Eigen::Vector3d(-0.025, 1.0, 2.0)).norm(), 1e-12);
}

TEST(PlayerOptions, HoldWhatHoldsForEveryTableAndAreDocumented) {
  PlayerOptions options;
  const OptionTable table = options_of(options);
  check_options(table);
  check_document(table, "Private parameters of rprr_sensor/PairPlayer.",
                 RPRR_CONFIG "/pair_player.yaml");
}

TEST(PlayerOptions, NeedASourceAndTwoRobots) {
  PlayerOptions options;
  EXPECT_NE(complete(options).find("source"), std::string::npos);
  options.source = "/recording";
  EXPECT_EQ(complete(options), "");
  EXPECT_FALSE(options.recording.camera) << "the source's own";
  options.b = options.a;
  EXPECT_NE(complete(options).find("b: eyebug_a"), std::string::npos);
}

TEST(PlayerOptions, AFocalLengthMakesACamera) {
  PlayerOptions options;
  options.source = "/recording";
  options.fx = 525.0;
  ASSERT_EQ(complete(options), "");
  ASSERT_TRUE(options.recording.camera);
  EXPECT_EQ(options.recording.camera->fy, 525.0);
  EXPECT_EQ(options.recording.camera->cx, 319.5);
  EXPECT_EQ(options.recording.camera->cy, 239.5);
  options.cx = 318.6;
  ASSERT_EQ(complete(options), "");
  EXPECT_EQ(options.recording.camera->cx, 318.6);
}

TEST(RelayOptions, HoldWhatHoldsForEveryTableAndAreDocumented) {
  RelayOptions options;
  const OptionTable table = options_of(options);
  check_options(table);
  check_document(table,
                 "Private parameters of rprr_sensor/CameraRelay. The defaults are what "
                 "freenect_launch and openni2_launch publish with depth_registration:=true.",
                 RPRR_CONFIG "/camera_relay.yaml");
}

}  // namespace
}  // namespace rprr
