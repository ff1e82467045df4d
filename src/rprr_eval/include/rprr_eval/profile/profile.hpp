// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_geometry/option_table.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_pose/pose_options.hpp"
#include "rprr_radio/send_queue.hpp"
#include "rprr_redundancy/redundancy_options.hpp"
#include "rprr_station/station_options.hpp"

namespace rprr {

/// The settings of every stage, from the same flat YAML file that the launch files give to the
/// nodelets (rprr_bringup/config/profiles). Defaults are profile `default`.
struct Profile : ExchangeOptions, RedundancyOptions {
  std::string name;
  FrameCodecOptions codec;
  SendQueueOptions sending;
  StationOptions station;
};

void list_options(Profile& profile, OptionTable& table);

/// "default", "paper", or the path of a YAML file. Parameters of nodes alone, which rprr_eval has
/// no use for, may stand in it. Errors name the file, the parameter and what is allowed: unknown
/// names, values of another kind or out of range, qualities that the colour codec has not.
Result<Profile> load_profile(const std::string& name_or_path);

}  // namespace rprr
