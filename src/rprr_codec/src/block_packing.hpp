// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "rprr_geometry/block_mask.hpp"

namespace rprr {

/// Where each block of a mask goes in a smaller grid.
struct BlockPacking {
  cv::Size size;              // of the smaller grid, blocks
  std::vector<int> blocks;    // of the mask's grid, in row order
  std::vector<cv::Point> to;  // column and row of each in the smaller grid
};

/// Rows and columns without any block of the mask are taken out: neighbours stay neighbours.
BlockPacking without_empty_lines(const BlockMask& mask);

/// Connected regions (over sides and corners), each in its rectangle widened to even columns and
/// rows, stand side by side on shelves: the highest first, of equals the one that begins first. So
/// the image codecs' squares of 16x16 pixels stay what they were.
BlockPacking on_shelves(const BlockMask& mask);

/// On shelves where that takes at most four fifths of the space, else without empty lines: seams
/// between regions cost bytes too.
BlockPacking packed(const BlockMask& mask);

}  // namespace rprr
