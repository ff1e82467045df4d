// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <string>

#include "rprr_station/scene_cloud.hpp"
#include "rprr_station/station_options.hpp"

namespace rprr {

struct StationParameters {
  StationOptions station;
  StationOutputOptions output;
  bool link_recovery = true;  // RadioLinks look after the robots' topics
};

/// All private parameters of the station's node: config/station.yaml.
OptionTable table_of(StationParameters& parameters);
/// Reads them. Empty, or what is wrong.
std::string read_station_parameters(const ros::NodeHandle& private_nh,
                                    StationParameters& parameters);
/// What follows from them for the clouds of scenes.
SceneCloudOptions cloud_options(const StationParameters& parameters);

}  // namespace rprr
