// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/block_mask.hpp"

namespace rprr {

/// The blocks of a mask moved together into a smaller image, so that a codec spends nothing on the
/// space between them. Both ends compute it from the mask alone; doc/encoded_frame.md has the rule.
/// Blocks that the camera's image cuts at its rim are continued to 8x8 pixels.
class CompactLayout {
 public:
  explicit CompactLayout(const BlockMask& mask);

  /// Size of the compact image [px]: multiples of 8, or 0x0 if the mask has no block. Its area is
  /// at most that of the mask's grid.
  cv::Size size() const { return {used_.grid().width, used_.grid().height}; }
  /// The blocks of the compact image that hold a block of the mask.
  const BlockMask& used() const { return used_; }

  /// Writes the mask's blocks of a CV_8UC3 image of the mask's size into the compact image; what is
  /// between them is left as it is.
  void gather(const cv::Mat& bgr, cv::Mat& compact) const;
  /// The other way: writes only the mask's blocks of bgr.
  void scatter(const cv::Mat& compact, cv::Mat& bgr) const;

 private:
  struct Move {
    cv::Rect whole;    // in the image, clipped to it
    cv::Rect compact;  // 8x8
  };
  std::vector<Move> moves_;
  BlockMask used_;
};

}  // namespace rprr
