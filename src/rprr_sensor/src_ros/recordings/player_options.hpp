// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_geometry/option_table.hpp"
#include "rprr_sensor/recordings/pair_schedule.hpp"
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
  bool required = false;       // the process ends where there is nothing to play
  RecordingOptions recording;  // its camera is made from the next
  double fx = 0.0;             // [px]; 0: the source's own camera
  double fy = 0.0;             // [px]; 0: as fx
  double cx = -1.0;            // [px]; negative: the image's centre
  double cy = -1.0;
  int width = 640;
  int height = 480;
};

void list_options(PlayerOptions& options, OptionTable& table);

/// What no single option shows. Empty, or what is wrong; else recording.camera is set where fx is.
std::string complete(PlayerOptions& options);

}  // namespace rprr
