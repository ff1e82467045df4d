// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_codec/encoded_frame.hpp"
#include "rprr_codec/fill.hpp"

namespace rprr {

/// What stands in the colour image where a block is not sent.
enum class UnsentFill { kBlack /* the paper's */, kSmooth /* harmonic, from the sent blocks */ };

struct FrameCodecOptions {
  std::string colour_codec = "pgf";
  int colour_quality = 6;  // the codec's own scale
  UnsentFill fill = UnsentFill::kSmooth;
  bool measure_independent =
      false;  // also encode the whole frame, to report what it would have cost
};

/// Depth and colour of one frame to payloads: one way in for the encoder nodelet and rprr_eval.
class FrameEncoder {
 public:
  /// Errors: what make_colour_encoder refuses.
  static Result<FrameEncoder> create(const FrameCodecOptions& options);

  /// Fills depth, colour, colour_codec and the independent bytes and encode time of the report from
  /// the images; camera, sparse, mask and the rest are the caller's. The encode time is that of
  /// what is sent, without the independent measurement. A sparse frame whose mask has no block gets
  /// empty payloads. Errors: images or a mask that are not of the camera's size, depth_mask beyond
  /// mask, an encoder that failed.
  Result<bool> encode(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame);

 private:
  explicit FrameEncoder(FrameCodecOptions options, std::unique_ptr<ColourEncoder> colour);
  cv::Mat fill_unsent(const cv::Mat& bgr, const BlockMask& sent);
  Result<bool> measure_independent(const DepthFrame& depth, const cv::Mat& bgr,
                                   EncodedFrame& frame);

  FrameCodecOptions options_;
  std::unique_ptr<ColourEncoder> colour_;
  std::unique_ptr<DhcmEncoder> depth_;
  SmoothFill smooth_;
};

struct DecodedFrame {
  DepthFrame depth;  // sparse: 0 outside of depth_blocks()
  cv::Mat bgr;       // CV_8UC3; sparse: meaningful in the mask's blocks only
};

/// Untrusted frame to images.
class FrameDecoder {
 public:
  explicit FrameDecoder(std::unique_ptr<ColourDecoder> colour);
  Result<DecodedFrame> decode(const EncodedFrame& frame);

 private:
  std::unique_ptr<ColourDecoder> colour_;
  std::unique_ptr<DhcmDecoder> depth_;
};

}  // namespace rprr
