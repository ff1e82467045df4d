// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "rprr_geometry/option_table.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_station/station.hpp"

namespace rprr {

enum class DepthEncoding { kAuto /* 16UC1 where a count is 1 mm */, kMillimetres, kMetres };

/// What the station publishes, beside what StationOptions rebuild. Defaults of both structs are
/// those of profile `default`.
struct StationOutputOptions {
  DepthEncoding depth_encoding = DepthEncoding::kAuto;
  double frustum_length = 0.5;                // m
  Duration cloud_period = from_seconds(0.5);  // least time between scene clouds
  std::size_t cloud_points = 1'000'000;       // of a scene cloud, at most
  std::size_t queue = 4;                      // messages of a robot that wait for the decoder
};

void list_options(StationOptions& options, OptionTable& table);
void list_options(StationOutputOptions& options, OptionTable& table);

}  // namespace rprr
