// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <opencv2/core/types.hpp>

namespace rprr {

/// Side of the paper's image blocks, pixels.
constexpr int kBlockSide = 8;

/// An image cut into 8x8 blocks, row by row; those at the right and lower rim may be smaller.
struct BlockGrid {
  int width = 0;  // of the image, pixels
  int height = 0;
  int columns = 0;  // blocks in a row
  int rows = 0;

  BlockGrid() = default;
  BlockGrid(int image_width, int image_height)
      : width(image_width),
        height(image_height),
        columns((image_width + kBlockSide - 1) / kBlockSide),
        rows((image_height + kBlockSide - 1) / kBlockSide) {}

  int count() const { return columns * rows; }
  int index(int column, int row) const { return row * columns + column; }
  /// Block that holds pixel (u, v).
  int index_of_pixel(int u, int v) const { return index(u / kBlockSide, v / kBlockSide); }
  /// Pixels of a block, clipped to the image.
  cv::Rect rect(int block) const {
    const int u = block % columns * kBlockSide;
    const int v = block / columns * kBlockSide;
    return {u, v, std::min(kBlockSide, width - u), std::min(kBlockSide, height - v)};
  }
};

}  // namespace rprr
