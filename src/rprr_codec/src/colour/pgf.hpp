// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// libpgf's quality scale: 0 lossless, 1 finest, 30 coarsest.
class PgfEncoder : public ColourEncoder {
 public:
  static ColourCodecInfo info() { return {"pgf", 0, 30}; }
  std::string name() const override { return info().name; }
  Result<Bytes> encode(const cv::Mat& bgr, int quality) override;
};

/// Payload of version 2: doc/encoded_frame.md. The PGF image has at least 16 pixels a side; what is
/// beyond width and height is cut off. libpgf is not safe against hostile bytes: call it in a
/// process that may die.
Result<cv::Mat> decode_pgf(ByteView payload, cv::Size expected);

/// What the payload's head states.
Result<cv::Size> pgf_payload_size(ByteView payload);
Result<int> pgf_payload_coarse(ByteView payload);

}  // namespace rprr
