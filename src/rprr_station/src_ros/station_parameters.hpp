// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include "rprr_geometry/result.hpp"
#include "rprr_station/scene_cloud.hpp"
#include "rprr_station/station.hpp"
#include "station_messages.hpp"

namespace rprr {

struct StationParameters {
  StationOptions station;
  DepthEncoding depth_encoding = DepthEncoding::kAuto;
  double frustum_length = 0.5;  // metres
  SceneCloudOptions cloud;
  Duration cloud_period = from_seconds(0.5);  // least time between scene clouds
  std::size_t queue = 4;                      // messages per robot that may wait for the decoder
  bool link_recovery = true;                  // RadioLinks look after the robots' topics
};

/// The private parameters of config/station.yaml. Errors name the parameter and what it may be.
Result<StationParameters> read_station_parameters(const ros::NodeHandle& private_nh);

}  // namespace rprr
