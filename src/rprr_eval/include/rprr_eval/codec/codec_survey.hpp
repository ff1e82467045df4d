// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_eval/codec/depth_codec.hpp"
#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// Blocks of a frame alone, coded by DHC-M, against the whole frame.
struct SparseFigures {
  double share = 0.0;           // of the blocks kept, in random connected regions
  double relative_bits = 0.0;   // bits per kept pixel over the whole frame's bits per pixel
  double bits_per_pixel = 0.0;  // kept ones
  double mask_bytes = 0.0;      // apart from the above
};

/// A codec over the frames of a folder: medians; times are the best of a few runs of each frame,
/// of the processor, on one core.
struct CodecFigures {
  std::string codec;
  std::string folder;
  bool colour = false;
  std::size_t frames = 0;
  double ratio = 0.0;  // raw bytes (16-bit depth, 24-bit colour) over coded ones
  double encode_ms = 0.0;
  double decode_ms = 0.0;
  bool lossless = false;              // every frame came back bit by bit
  double psnr = 0.0;                  // of colour, where it is not lossless
  std::vector<SparseFigures> sparse;  // of a codec that has it
};

/// All codecs side by side: each frame goes through one after the other, so that what else the
/// machine does meets all alike. Repeats: at least 1.
std::vector<CodecFigures> survey_depth(const std::string& folder,
                                       const std::vector<DepthFrame>& frames,
                                       const std::vector<NamedDepthCodec>& codecs, int repeats);

/// `draws` random masks for each frame and share.
std::vector<SparseFigures> survey_sparse(const std::vector<DepthFrame>& frames, DhcmMode mode,
                                         const std::vector<double>& shares, int draws);

CodecFigures survey_colour(const std::string& folder, const std::vector<cv::Mat>& images,
                           ColourEncoder& encoder, int quality, ColourDecoder& decoder,
                           int repeats);

/// Markdown: ratios, times, times as multiples of RVL's (where that was measured) and what sparse
/// frames cost; a column a folder. Colour is left out.
std::string codec_tables(const std::vector<CodecFigures>& figures);

}  // namespace rprr
