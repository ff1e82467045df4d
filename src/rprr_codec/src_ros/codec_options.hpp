// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include "rprr_codec/frame_codec.hpp"

namespace rprr {

/// Reads what config/encoder.yaml documents. Errors name the parameter and what it may be; whether
/// codecs and qualities exist is for FrameEncoder to say.
Result<FrameCodecOptions> read_codec_options(const ros::NodeHandle& nh);

}  // namespace rprr
