// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_codec/EncoderConfig.h>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_radio/send_queue.hpp"
#include "rprr_ros/parameters.hpp"

namespace rprr {

/// Reads what config/encoder.yaml documents. Errors name the parameter and what it may be; whether
/// codecs and qualities exist is for FrameEncoder to say.
Result<FrameCodecOptions> read_codec_options(const Parameters& given);
Result<SendQueueOptions> read_send_options(const Parameters& given, const std::string& robot);

/// The options with what dynamic_reconfigure says. Errors as above.
Result<FrameCodecOptions> with_config(FrameCodecOptions options,
                                      const rprr_codec::EncoderConfig& config);

}  // namespace rprr
