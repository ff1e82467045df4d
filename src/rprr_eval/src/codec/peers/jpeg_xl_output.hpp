// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <jxl/encode_cxx.h>

#include <algorithm>

#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Everything that an encoder whose input is closed has to give. buffer is kept between calls.
inline bool drain_jpeg_xl(JxlEncoder* encoder, Bytes& buffer, Bytes& coded) {
  buffer.resize(std::max<std::size_t>(buffer.size(), 1 << 20));
  std::uint8_t* next = buffer.data();
  std::size_t left = buffer.size();
  JxlEncoderStatus status;
  while ((status = JxlEncoderProcessOutput(encoder, &next, &left)) == JXL_ENC_NEED_MORE_OUTPUT) {
    const std::size_t used = buffer.size() - left;
    buffer.resize(buffer.size() * 2);
    next = buffer.data() + used;
    left = buffer.size() - used;
  }
  coded.assign(buffer.data(), next);
  return status == JXL_ENC_SUCCESS;
}

}  // namespace rprr
