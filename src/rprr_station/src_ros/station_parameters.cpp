// SPDX-License-Identifier: BSD-3-Clause
#include "station_parameters.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "rprr_geometry_ros/parameters.hpp"

namespace rprr {
namespace {

// One of a few named values.
template <typename T>
bool choose(const Parameters& given, const std::string& name, const std::map<std::string, T>& all,
            const std::string& fallback, T& value, std::string& problem) {
  const std::string text = given.param<std::string>(name, fallback);
  const auto found = all.find(text);
  if (found == all.end()) {
    problem = "~" + name + " is '" + text + "'; it may be";
    for (const auto& [key, unused] : all) problem += " " + key;
    return false;
  }
  value = found->second;
  return true;
}

std::size_t at_least(const Parameters& given, const std::string& name, int fallback, int least) {
  return static_cast<std::size_t>(std::max(given.param(name, fallback), least));
}

Result<std::vector<std::string>> read_robots(const Parameters& given) {
  const auto robots = given.param("robots", std::vector<std::string>());
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

Result<StationParameters> read_station_parameters(const ros::NodeHandle& private_nh) {
  const Parameters given(private_nh);
  StationParameters parameters;
  StationOptions& station = parameters.station;
  const Result<std::vector<std::string>> robots = read_robots(given);
  if (!robots) return Error{robots.reason()};
  station.robots = *robots;

  std::string problem;
  const bool named =
      choose<Synthesis>(given, "synthesis",
                        {{"forward", Synthesis::kForward}, {"backward", Synthesis::kBackward}},
                        "backward", station.synthesis.mode, problem) &&
      choose<UnknownFill>(given, "unknown_fill",
                          {{"black", UnknownFill::kBlack}, {"smooth", UnknownFill::kSmooth}},
                          "smooth", station.stitch.fill, problem) &&
      choose<DepthEncoding>(given, "depth_encoding",
                            {{"auto", DepthEncoding::kAuto},
                             {"16UC1", DepthEncoding::kMillimetres},
                             {"32FC1", DepthEncoding::kMetres}},
                            "auto", parameters.depth_encoding, problem);
  if (!named) return Error{problem};

  CrackFilterOptions& filter = station.synthesis.crack_filter;
  filter.cracks = given.param("mend_cracks", true);
  filter.ghosts = given.param("mend_ghosts", true);
  filter.range = static_cast<float>(given.param("mend_range", 0.05));
  filter.largest_window = given.param("mend_largest_window", 7);
  station.synthesis.surface_tolerance = static_cast<float>(given.param("surface_tolerance", 0.05));

  station.synthesis.align = given.param("align", true);
  station.stitch.edge_margin = at_least(given, "edge_margin", 2, 0);

  station.references_held = at_least(given, "references_held", 4, 1);
  station.waiting = at_least(given, "waiting", 4, 0);
  station.wait_for_reference = from_seconds(given.param("wait_for_reference", 2.0));
  station.largest_message = at_least(given, "largest_message", 8 << 20, 1);
  station.largest_image = at_least(given, "largest_image", 1920 * 1200, 1);
  station.energy.bytes_per_second = given.param("radio_bytes_per_second", 1e6);
  parameters.frustum_length = std::max(given.param("frustum_length", 0.5), 0.01);
  parameters.cloud.references = station.references_held;
  parameters.cloud.views = std::max<std::size_t>(station.robots.size(), 2) - 1;
  parameters.cloud.most_points = at_least(given, "cloud_points", 1000000, 1);
  parameters.cloud_period = from_seconds(std::max(given.param("cloud_period", 0.5), 0.0));
  parameters.queue = at_least(given, "queue", 4, 1);
  return parameters;
}

}  // namespace rprr
