// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Lossy WebP, that is, a key frame of VP8.
class WebpEncoder : public ColourEncoder {
 public:
  static ColourCodecInfo info() { return {"webp", 100, 0}; }
  std::string name() const override { return info().name; }
  Result<Bytes> encode(const cv::Mat& bgr, int quality) override;
};

/// Payload: the VP8 frame (RFC 6386) without the RIFF container, u32 CRC-32.
Result<cv::Mat> decode_webp(ByteView payload, cv::Size expected);

/// What its frame header states.
Result<cv::Size> webp_payload_size(ByteView payload);

}  // namespace rprr
