// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_codec/colour_layers.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_codec/encoded_frame.hpp"

namespace rprr {

struct FrameCodecOptions {
  std::string colour_codec = "pgf";
  int colour_quality = 6;  // the codec's own scale
  std::string base_codec;  // empty: colour_codec
  int base_reduction = 0;  // of sparse frames; 0: no base; 1, 2, 4, 8
  int base_quality = 12;   // the codec's own scale
  UnsentFill fill = UnsentFill::kSmooth;
  bool measure_independent =
      false;  // also encode the whole frame, to report what it would have cost
};

/// How the colour of one frame is sent. Of a whole frame only detail_quality counts.
struct LayerSettings {
  int base_reduction = 0;  // 0: no base; 1, 2, 4, 8
  int base_quality = 0;    // the codec's own scale
  int detail_quality = 0;  // the codec's own scale
  bool detail = true;      // false: the base alone
};

/// Depth and colour of one frame to payloads: one way in for the encoder nodelet and rprr_eval.
class FrameEncoder {
 public:
  /// Errors: names, qualities or a reduction that do not exist.
  static Result<FrameEncoder> create(const FrameCodecOptions& options);

  /// Fills depth, colour, base, what describes them, and the independent bytes and encode time of
  /// the report from the images; camera, sparse, masks and the rest are the caller's. The encode
  /// time is that of what is sent, without the independent measurement. A sparse frame whose mask
  /// has no block gets empty depth and detail. Errors: images or a mask that are not of the
  /// camera's size, depth_mask beyond mask, settings out of range or without any colour, an encoder
  /// that failed.
  Result<bool> encode(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame,
                      const LayerSettings& settings);
  /// With the options' settings.
  Result<bool> encode(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame);

  /// encode in steps, for whoever tries several settings: depth and preparations once, then colours
  /// as often as one likes (through layers() without a frame). bgr is shared until the next frame.
  Result<bool> prepare(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame);
  Result<bool> encode_colour(EncodedFrame& frame, const LayerSettings& settings);
  ColourLayers& layers() { return layers_; }

  /// Those of the options.
  LayerSettings settings() const;

 private:
  FrameEncoder(FrameCodecOptions options, ColourLayers layers);
  Result<bool> measure_independent(const DepthFrame& depth, int quality, EncodedFrame& frame);

  FrameCodecOptions options_;
  ColourLayers layers_;
  std::unique_ptr<DhcmEncoder> depth_;
};

struct DecodedFrame {
  DepthFrame depth;  // sparse: 0 outside of depth_blocks()
  cv::Mat bgr;       // CV_8UC3, detail; sparse: black outside of the mask's blocks
  cv::Mat base;  // CV_8UC3 of base_size(), coarse; empty if there is none. Where there is detail
                 // only a continuation of the rest
  bool has_detail = true;  // false: bgr is black
  int coarse = 0;          // how often the detail's resolution is halved: its payload was cut
};

/// Untrusted frame to images.
class FrameDecoder {
 public:
  explicit FrameDecoder(std::unique_ptr<ColourDecoder> colour);
  Result<DecodedFrame> decode(const EncodedFrame& frame);

 private:
  Result<bool> decode_depth(const EncodedFrame& frame, DecodedFrame& decoded);
  Result<bool> decode_detail(const EncodedFrame& frame, DecodedFrame& decoded);
  Result<bool> decode_base(const EncodedFrame& frame, DecodedFrame& decoded);

  std::unique_ptr<ColourDecoder> colour_;
  std::unique_ptr<DhcmDecoder> depth_;
};

}  // namespace rprr
