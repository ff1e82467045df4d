// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_pose/preview_protocol.hpp"
#include "rprr_pose/samples_protocol.hpp"
#include "rprr_radio/send_queue.hpp"
#include "rprr_redundancy/validation.hpp"
#include "rprr_station/station.hpp"

namespace rprr {

/// The settings of every stage, from the same flat YAML file that the launch files give to the
/// nodelets (config/profiles). Keys that are not there keep their defaults.
struct Profile {
  std::string name;
  bool use_previews = true;  // protocol: preview, or samples
  PreviewOptions preview;
  SamplesOptions samples;
  ValidationOptions validation;
  FrameCodecOptions codec;
  SendQueueOptions sending;
  StationOptions station;
};

/// "default", "paper", or the path of a YAML file. Errors name the file and the key.
Result<Profile> load_profile(const std::string& name_or_path);

}  // namespace rprr
