// SPDX-License-Identifier: BSD-3-Clause
#include "station_parameters.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace rprr {
namespace {

// One of a few named values.
template <typename T>
bool choose(const ros::NodeHandle& nh, const std::string& name, const std::map<std::string, T>& all,
            const std::string& fallback, T& value, std::string& problem) {
  const std::string text = nh.param<std::string>(name, fallback);
  const auto found = all.find(text);
  if (found == all.end()) {
    problem = "~" + name + " is '" + text + "'; it may be";
    for (const auto& [key, unused] : all) problem += " " + key;
    return false;
  }
  value = found->second;
  return true;
}

std::size_t at_least(const ros::NodeHandle& nh, const std::string& name, int fallback, int least) {
  return static_cast<std::size_t>(std::max(nh.param(name, fallback), least));
}

Result<std::vector<std::string>> read_robots(const ros::NodeHandle& nh) {
  const auto robots = nh.param("robots", std::vector<std::string>());
  if (robots.empty()) return Error{"~robots is empty; list the robots that the station hears"};
  for (const std::string& robot : robots) {
    std::string problem;
    if (robot.empty() || robot.find('/') != std::string::npos ||
        !ros::names::validate(robot, problem)) {
      return Error{"~robots: '" + robot + "' is no ROS name"};
    }
  }
  if (std::set<std::string>(robots.begin(), robots.end()).size() != robots.size()) {
    return Error{"~robots names a robot twice"};
  }
  return robots;
}

}  // namespace

Result<StationParameters> read_station_parameters(const ros::NodeHandle& nh) {
  StationParameters parameters;
  StationOptions& station = parameters.station;
  const Result<std::vector<std::string>> robots = read_robots(nh);
  if (!robots) return Error{robots.reason()};
  station.robots = *robots;

  std::string problem;
  const bool named =
      choose<Synthesis>(nh, "synthesis",
                        {{"forward", Synthesis::kForward}, {"backward", Synthesis::kBackward}},
                        "backward", station.synthesis.mode, problem) &&
      choose<UnknownFill>(nh, "unknown_fill",
                          {{"black", UnknownFill::kBlack}, {"smooth", UnknownFill::kSmooth}},
                          "smooth", station.stitch.fill, problem) &&
      choose<DepthEncoding>(nh, "depth_encoding",
                            {{"auto", DepthEncoding::kAuto},
                             {"16UC1", DepthEncoding::kMillimetres},
                             {"32FC1", DepthEncoding::kMetres}},
                            "auto", parameters.depth_encoding, problem);
  if (!named) return Error{problem};

  CrackFilterOptions& filter = station.synthesis.crack_filter;
  filter.cracks = nh.param("mend_cracks", true);
  filter.ghosts = nh.param("mend_ghosts", true);
  filter.range = static_cast<float>(nh.param("mend_range", 0.05));
  filter.largest_window = nh.param("mend_largest_window", 7);
  station.synthesis.surface_tolerance = static_cast<float>(nh.param("surface_tolerance", 0.05));

  station.synthesis.align = nh.param("align", true);
  station.stitch.edge_margin = at_least(nh, "edge_margin", 2, 0);

  station.references_held = at_least(nh, "references_held", 4, 1);
  station.waiting = at_least(nh, "waiting", 4, 0);
  station.wait_for_reference = from_seconds(nh.param("wait_for_reference", 2.0));
  station.largest_message = at_least(nh, "largest_message", 8 << 20, 1);
  station.largest_image = at_least(nh, "largest_image", 1920 * 1200, 1);
  station.energy.bytes_per_second = nh.param("radio_bytes_per_second", 1e6);
  parameters.frustum_length = std::max(nh.param("frustum_length", 0.5), 0.01);
  parameters.cloud.references = station.references_held;
  parameters.cloud.views = std::max<std::size_t>(station.robots.size(), 2) - 1;
  parameters.cloud.most_points = at_least(nh, "cloud_points", 1000000, 1);
  parameters.cloud_period = from_seconds(std::max(nh.param("cloud_period", 0.5), 0.0));
  parameters.queue = at_least(nh, "queue", 4, 1);
  return parameters;
}

}  // namespace rprr
