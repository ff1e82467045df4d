// SPDX-License-Identifier: BSD-3-Clause
#include "station_parameters.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "rprr_ros/parameters.hpp"

namespace rprr {
namespace {

// One of a few named values. Empty, or what is wrong.
template <typename T>
std::string choose(const Parameters& given, const std::string& name,
                   const std::map<std::string, T>& all, const std::string& fallback, T& value) {
  const std::string text = given.param<std::string>(name, fallback);
  const auto found = all.find(text);
  if (found == all.end()) {
    std::string problem = "~" + name + " is '" + text + "'; it may be";
    for (const auto& [key, unused] : all) problem += " " + key;
    return problem;
  }
  value = found->second;
  return {};
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

// What is chosen by name. Empty, or what is wrong.
std::string read_choices(const Parameters& given, StationParameters& parameters) {
  const std::string problems[] = {
      choose<Synthesis>(given, "synthesis",
                        {{"forward", Synthesis::kForward}, {"backward", Synthesis::kBackward}},
                        "backward", parameters.station.synthesis.mode),
      choose<UnknownFill>(given, "unknown_fill",
                          {{"black", UnknownFill::kBlack}, {"smooth", UnknownFill::kSmooth}},
                          "smooth", parameters.station.stitch.fill),
      choose<DepthEncoding>(given, "depth_encoding",
                            {{"auto", DepthEncoding::kAuto},
                             {"16UC1", DepthEncoding::kMillimetres},
                             {"32FC1", DepthEncoding::kMetres}},
                            "auto", parameters.depth_encoding)};
  for (const std::string& problem : problems) {
    if (!problem.empty()) return problem;
  }
  return {};
}

void read_rebuilding(const Parameters& given, StationOptions& station) {
  CrackFilterOptions& filter = station.synthesis.crack_filter;
  filter.cracks = given.param("mend_cracks", true);
  filter.ghosts = given.param("mend_ghosts", true);
  filter.range = static_cast<float>(given.param("mend_range", 0.05));
  filter.largest_window = given.param("mend_largest_window", 7);
  station.synthesis.surface_tolerance = static_cast<float>(given.param("surface_tolerance", 0.05));
  station.synthesis.align = given.param("align", true);
  station.stitch.edge_margin = at_least(given, "edge_margin", 2, 0);
}

// How much is kept, waited for and accepted.
void read_bounds(const Parameters& given, StationOptions& station) {
  station.references_held = at_least(given, "references_held", 4, 1);
  station.waiting = at_least(given, "waiting", 4, 0);
  station.wait_for_reference = from_seconds(given.param("wait_for_reference", 2.0));
  station.largest_message = at_least(given, "largest_message", 8 << 20, 1);
  station.largest_image = at_least(given, "largest_image", 1920 * 1200, 1);
}

void read_cloud(const Parameters& given, StationParameters& parameters) {
  const StationOptions& station = parameters.station;
  parameters.cloud.references = station.references_held;
  parameters.cloud.views = std::max<std::size_t>(station.robots.size(), 2) - 1;
  parameters.cloud.most_points = at_least(given, "cloud_points", 1000000, 1);
  parameters.cloud_period = from_seconds(std::max(given.param("cloud_period", 0.5), 0.0));
}

}  // namespace

Result<StationParameters> read_station_parameters(const ros::NodeHandle& private_nh) {
  const Parameters given(private_nh);
  StationParameters parameters;
  const Result<std::vector<std::string>> robots = read_robots(given);
  if (!robots) return Error{robots.reason()};
  parameters.station.robots = *robots;
  const std::string problem = read_choices(given, parameters);
  if (!problem.empty()) return Error{problem};
  read_rebuilding(given, parameters.station);
  read_bounds(given, parameters.station);
  read_cloud(given, parameters);
  parameters.station.energy.bytes_per_second = given.param("radio_bytes_per_second", 1e6);
  parameters.frustum_length = std::max(given.param("frustum_length", 0.5), 0.01);
  parameters.queue = at_least(given, "queue", 4, 1);
  parameters.link_recovery = given.param("link_recovery", parameters.link_recovery);
  return parameters;
}

}  // namespace rprr
