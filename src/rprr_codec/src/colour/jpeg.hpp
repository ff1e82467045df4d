// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Baseline JPEG, colours at half the resolution, Huffman tables fitted to each image.
class JpegEncoder : public ColourEncoder {
 public:
  static ColourCodecInfo info() { return {"jpeg", 100, 1}; }
  std::string name() const override { return info().name; }
  Result<Bytes> encode(const cv::Mat& bgr, int quality) override;
  bool prefers_flat_blocks() const override { return true; }
};

/// Payload: a JPEG image without JFIF header, u32 CRC-32. Call it in a process that may die.
Result<cv::Mat> decode_jpeg(ByteView payload, cv::Size expected);

/// What its frame header states.
Result<cv::Size> jpeg_payload_size(ByteView payload);

}  // namespace rprr
