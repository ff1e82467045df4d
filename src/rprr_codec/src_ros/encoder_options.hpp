// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_radio/send_queue.hpp"

namespace rprr {

/// All private parameters of the encoder's node: config/encoder.yaml.
struct EncoderOptions {
  std::string robot = "eyebug_a";
  bool link_recovery = true;  // RadioLinks look after the station's receipts
  FrameCodecOptions codec;
  SendQueueOptions sending;
};

OptionTable table_of(EncoderOptions& options);

}  // namespace rprr
