// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_geometry/option_table.hpp"
#include "rprr_sensor/pair_schedule.hpp"
#include "rprr_sensor_ros/recording.hpp"

namespace rprr {

/// All private parameters of rprr_sensor/PairPlayer: config/pair_player.yaml.
struct PlayerOptions {
  std::string source;
  std::string a = "eyebug_a";
  std::string b = "eyebug_b";
  PairScheduleOptions schedule;
  double rate = 1.0;  // pairs a second; 0: by the handshake, or by ~next
  bool handshake = false;
  double handshake_timeout = 10.0;  // s of wall time
  int wait_for_subscribers = 1;
  double wait_timeout = 30.0;  // s of wall time; negative: without end
  RecordingOptions recording;  // its camera is made from the next
  double fx = 0.0;             // pixels; 0: the source's own camera
  double fy = 0.0;             // pixels; 0: as fx
  double cx = -1.0;            // pixels; negative: the image's centre
  double cy = -1.0;
  int width = 640;
  int height = 480;
};

void list_options(PlayerOptions& options, OptionTable& table);

/// What no single option shows. Empty, or what is wrong; else recording.camera is set where fx is.
std::string complete(PlayerOptions& options);

/// All private parameters of rprr_sensor/CameraRelay: config/camera_relay.yaml. The topics are
/// those of freenect_launch and openni2_launch with depth_registration:=true.
struct RelayOptions {
  std::string robot = "eyebug_a";
  std::string rgb_topic = "/camera/rgb/image_rect_color";
  std::string camera_info_topic = "/camera/rgb/camera_info";
  std::string depth_topic = "/camera/depth_registered/hw_registered/image_rect_raw";
};

void list_options(RelayOptions& options, OptionTable& table);

}  // namespace rprr
