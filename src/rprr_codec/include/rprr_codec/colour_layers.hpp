// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "rprr_codec/colour_codec.hpp"
#include "rprr_codec/compact_layout.hpp"
#include "rprr_codec/encoded_frame.hpp"
#include "rprr_codec/fill.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// What stands in the colour image where a block is not sent.
enum class UnsentFill { kBlack /* the paper's */, kSmooth /* harmonic, from the sent blocks */ };

/// Size of the base of an image.
cv::Size base_size(cv::Size image, int reduction);
/// The base itself: means of cells of reduction x reduction pixels, fewer at the rim. CV_8UC3.
void reduce_image(const cv::Mat& bgr, int reduction, cv::Mat& reduced);

/// A row of the image that a base stands for, bilinearly. out: CV_8UC3, one row of its width.
void enlarge_row(const cv::Mat& base, int reduction, int row, cv::Mat& out);

/// The colour of one frame, prepared once and then encoded at as many settings as one likes: a rate
/// planner tries several. One object serves one thread and keeps its buffers between frames.
class ColourLayers {
 public:
  /// Detail and base are of one codec. Errors: an unknown name.
  static Result<ColourLayers> create(const std::string& codec, UnsentFill fill);

  /// Takes up a frame. bgr: CV_8UC3, shared, not to be altered until the next frame. sent: the
  /// blocks of the detail, of the image's grid; null if the frame is whole.
  void prepare(const cv::Mat& bgr, const BlockMask* sent);

  /// The whole image, or the blocks sent in the layout that layout() states. Errors: nothing
  /// prepared, no block at all, what the codec refuses.
  Result<Bytes> encode_detail(int quality);
  /// The base. with_detail: the detail is sent too, so blocks that are in it need not be right here
  /// and are filled from the others. Errors as above, a reduction that is none.
  Result<Bytes> encode_base(int reduction, int quality, bool with_detail = true);
  /// What encode_base encodes.
  const cv::Mat& base(int reduction, bool with_detail);
  /// The whole image, whatever is sent of it.
  Result<Bytes> encode_whole(int quality);

  /// How the detail layer's blocks are laid out: compact where that makes the image smaller, and
  /// never with black fill (the paper's).
  ColourLayout layout() const { return layout_; }
  /// The frame's own.
  const cv::Mat& image() const { return bgr_; }
  std::string codec() const { return codec_->name(); }
  ColourCodecInfo info() const { return *colour_codec_info(codec()); }

 private:
  ColourLayers(std::unique_ptr<ColourEncoder> codec, UnsentFill fill);
  void choose_layout();
  void fill(cv::Mat& bgr, const BlockMask& known, int reduction, bool flat);
  const cv::Mat& detail();

  std::unique_ptr<ColourEncoder> codec_;
  UnsentFill fill_;
  SmoothFill smooth_;

  cv::Mat bgr_;
  std::optional<BlockMask> sent_;
  std::optional<CompactLayout> compact_;
  BlockMask unsent_;
  ColourLayout layout_ = ColourLayout::kInPlace;

  struct Prepared {
    bool ready = false;
    cv::Mat image;
  };
  Prepared detail_;
  std::array<Prepared, 10> bases_;  // by reduction, without and with detail
};

}  // namespace rprr
