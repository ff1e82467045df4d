// SPDX-License-Identifier: BSD-3-Clause
#include "station_parameters.hpp"

#include <algorithm>

#include "rprr_ros/parameters.hpp"

namespace rprr {

OptionTable table_of(StationParameters& parameters) {
  OptionTable table = options_of(parameters.station);
  table.append(options_of(parameters.output));
  return table;
}

std::string read_station_parameters(const ros::NodeHandle& private_nh,
                                    StationParameters& parameters) {
  const std::string wrong = read_parameters(private_nh, table_of(parameters));
  if (!wrong.empty() || !parameters.station.robots.empty()) return wrong;
  return "robots: [] is not, allowed: the robots that the station hears, at least one";
}

SceneCloudOptions cloud_options(const StationParameters& parameters) {
  SceneCloudOptions cloud;
  cloud.references = parameters.station.references_held;
  cloud.views = std::max<std::size_t>(parameters.station.robots.size(), 2) - 1;
  cloud.most_points = parameters.output.cloud_points;
  return cloud;
}

}  // namespace rprr
