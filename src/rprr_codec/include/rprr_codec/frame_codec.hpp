// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_codec/colour_layers.hpp"
#include "rprr_codec/depth_rounder.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_codec/encoded_frame.hpp"
#include "rprr_codec/layer_ladder.hpp"
#include "rprr_geometry/option_table.hpp"

namespace rprr {

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
  /// Detail and base without the depth.
  Result<DecodedFrame> decode_colours(const EncodedFrame& frame);
  /// The base alone; an error where there is none.
  Result<cv::Mat> decode_base(const EncodedFrame& frame);

 private:
  Result<bool> decode_depth(const EncodedFrame& frame, DecodedFrame& decoded);
  Result<bool> decode_layers(const EncodedFrame& frame, DecodedFrame& decoded);
  Result<bool> decode_detail(const EncodedFrame& frame, DecodedFrame& decoded);

  std::unique_ptr<ColourDecoder> colour_;
  std::unique_ptr<DhcmDecoder> depth_;
};

/// What decides how fine the colours of a sparse frame are, objectives kView and kMap.
struct SparseColours {
  enum class By {
    kQuality,  // FrameCodecOptions::colour_quality
    kBytes,    // the finest with which the encoded frame, depth and all, is not longer than amount
    kPsnr,     // the coarsest with which what is sent comes so near to the camera's image
  };
  By by = By::kQuality;
  double amount = 0.0;  // kBytes: bytes, above 0; kPsnr: dB, above 0
};
/// "quality", "bytes:12000" (a whole number above 0) or "psnr:34.5"; none of anything else.
std::optional<SparseColours> sparse_colours_of(const std::string& text);
std::string text_of(const SparseColours& colours);

/// A view that is rebuilt is like a whole image of this share of colour_quality, on WebP's scale.
/// Below 1, since whole frames are references: what is lost in them is lost in every view predicted
/// from them. At half, quality 40 gives views like whole images of quality 20: docs/quality.md.
constexpr double kViewShare = 0.5;

/// How a frame is coded. Defaults are those of profile `default`.
///
/// How fine colours are, first what goes first:
/// 1. The radio: the limit of FrameEncoder::encode_within, which SendQueue sets on a narrow radio.
///    No setting makes a frame longer.
/// 2. sparse_colours, of sparse frames under objectives kView and kMap, where it names bytes or a
///    PSNR.
/// 3. colour_quality, the one knob: whole frames have it; under kFixed and kMap so have the blocks
///    that are sent, and under kView the picture follows it (kViewShare).
struct FrameCodecOptions {
  DhcmMode depth_mode = DhcmMode::kSmall;
  std::string colour_codec = "webp";
  /// On the codec's own scale. webp: 0 coarsest to 100 finest. jpeg: 1 to 100. pgf: 30 coarsest to
  /// 1 finest, 0 lossless.
  int colour_quality = 40;
  /// What the colours of sparse frames are for. kFixed sends the mask's blocks and no base.
  Objective objective = Objective::kView;
  SparseColours sparse_colours;
  /// encode_within may round depth to steps of inverse depth, 1/metre, of up to this; 0: it stays
  /// lossless. A Kinect's own step is 0.00285.
  double depth_step = 0.0;
  UnsentFill fill = UnsentFill::kSmooth;
  /// Also encode the whole frame, to report what it would have cost.
  bool measure_independent = false;
};

/// Live: objective, colour_quality, sparse_colours.
void list_options(FrameCodecOptions& options, OptionTable& table);

/// Depth and colour of one frame to payloads: one way in for the encoder nodelet and rprr_eval.
class FrameEncoder {
 public:
  /// Errors: a codec that does not exist, a quality that the codec has not, sparse_colours that
  /// objective kFixed takes no notice of.
  static Result<FrameEncoder> create(const FrameCodecOptions& options);

  /// Fills depth, colour, base, what describes them, and the independent bytes and encode time of
  /// the report from the images; camera, sparse, masks and the rest are the caller's. The encode
  /// time is that of what is sent, without the independent measurement. A sparse frame whose mask
  /// has no block gets empty depth and detail. Errors: images or a mask that are not of the
  /// camera's size, depth_mask beyond mask, settings out of range or without any colour, an encoder
  /// that failed.
  Result<bool> encode(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame,
                      const LayerSettings& settings);
  /// With the settings that the options ask for. Where no detail is sent, the blocks without depth
  /// leave frame.mask.
  Result<bool> encode(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame);
  /// The same, or where that is longer than limit (bytes of the encoded frame; 0: none) the finest
  /// coarser colours that are within it. Colours are left a fifth of the frame at least: below,
  /// they lose much and save little. Depth that is longer than the rest of the limit is rounded as
  /// depth_step allows, no more than needed. What does not fit even so is longer than the limit.
  Result<bool> encode_within(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame,
                             std::size_t limit);

  /// encode in steps, for whoever tries several settings: depth and preparations once, then colours
  /// as often as one likes (through layers() without a frame). bgr is shared until the next frame.
  Result<bool> prepare(const DepthFrame& depth, const cv::Mat& bgr, EncodedFrame& frame);
  Result<bool> encode_colour(EncodedFrame& frame, const LayerSettings& settings);
  ColourLayers& layers() { return layers_; }

  /// Those of the options with objective kFixed; of whole frames.
  LayerSettings settings() const;

 private:
  FrameEncoder(FrameCodecOptions options, ColourLayers layers);
  Result<bool> measure_independent(const DepthFrame& depth, int quality, EncodedFrame& frame);
  using Judge = std::function<bool(const EncodedFrame&)>;
  Result<bool> encode_as_asked(EncodedFrame& frame);
  Result<bool> plan(EncodedFrame& frame);
  Result<bool> coarsen(EncodedFrame& frame, std::size_t limit);
  void encode_depth(const DepthFrame& depth, EncodedFrame& frame);
  void round_depth(const DepthFrame& depth, EncodedFrame& frame, std::size_t limit);
  std::vector<LayerSettings> coarser_settings(const EncodedFrame& frame) const;
  Result<bool> search(const std::vector<LayerSettings>& rungs, bool finest, const Judge& good,
                      int& last, EncodedFrame& frame);
  const LayerLadder& ladder_for(const EncodedFrame& frame) const;
  Result<bool> try_settings(const LayerSettings& settings, EncodedFrame& frame);
  Result<double> sent_psnr(const EncodedFrame& frame);
  Result<float> noise_of_base(const EncodedFrame& frame, bool with_detail);

  FrameCodecOptions options_;
  ColourLayers layers_;
  std::array<LayerLadder, 2> ladders_;  // for many blocks, for few
  int last_rung_;                       // where the search for the next frame's begins
  int last_coarse_rung_ = 0;  // where it begins for frames coarser than the options ask for
  std::unique_ptr<DhcmEncoder> depth_;
  DepthRounder rounder_;
  FrameDecoder own_decoder_;  // of payloads of our own making, in this process
};

}  // namespace rprr
