// SPDX-License-Identifier: BSD-3-Clause
#include "station_parameters.hpp"

#include <algorithm>

#include "rprr_ros/parameters.hpp"

namespace rprr {

void list_options(StationParameters& parameters, OptionTable& table) {
  list_options(parameters.station, table);
  list_options(parameters.output, table);
  table.group("Links to the robots");
  table.flag("link_recovery", parameters.link_recovery,
             "Make subscriptions to robots anew when their host answers again after a silence; "
             "false: left to TCP, which may take as long again as the silence was");
}

OptionTable table_of(StationParameters& parameters) {
  return options_of(parameters);
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
