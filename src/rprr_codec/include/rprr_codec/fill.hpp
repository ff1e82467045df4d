// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/block_mask.hpp"

namespace rprr {

/// Colours for the blocks that are not sent, so that an image codec spends little on them: a smooth
/// (about harmonic) continuation of the sent blocks, by a pyramid and a few relaxation sweeps at
/// each of its levels. Keeps its buffers between images; one object serves one thread.
class SmoothFill {
 public:
  /// A copy of the 8-bit BGR image in which only pixels outside the mask's blocks differ. The mask
  /// is of the image's grid. Black where no block at all is sent.
  cv::Mat fill(const cv::Mat& bgr, const BlockMask& sent);

  /// Fills without a copy, in an image of which each pixel stands for reduction x reduction
  /// pixels of the mask's grid: 1, 2, 4 or 8. A block is 8 / reduction pixels wide and high. flat:
  /// each unknown block in one colour, for codecs of blocks that predict nothing but that.
  void fill_in_place(cv::Mat& bgr, const BlockMask& known, int reduction = 1, bool flat = false);

 private:
  std::array<cv::Mat, 4> levels_;  // CV_8UC3; level k has cells of 2^k pixels, 3 is a block
  std::vector<std::uint8_t> scratch_;
  std::vector<std::uint16_t> blend_;
};

/// A copy with all pixels outside the mask's blocks black: the paper's.
cv::Mat black_fill(const cv::Mat& bgr, const BlockMask& sent);
/// Blackens the pixels outside of the mask's blocks without a copy; reduction as in SmoothFill.
void black_out(cv::Mat& bgr, const BlockMask& known, int reduction = 1);

}  // namespace rprr
