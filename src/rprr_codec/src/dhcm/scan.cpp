// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/scan.hpp"

#include <algorithm>

namespace rprr::dhcm {

bool Segments::coded(int column, int row) const {
  if (column < 0 || row < 0 || column >= grid_.columns) return false;
  return mask_ == nullptr || (*mask_)[grid_.index(column, row)];
}

std::size_t Segments::pixels() const {
  if (mask_ == nullptr) return static_cast<std::size_t>(grid_.width) * grid_.height;
  std::size_t count = 0;
  for (int block = 0; block < grid_.count(); ++block) {
    if ((*mask_)[block]) count += static_cast<std::size_t>(grid_.rect(block).area());
  }
  return count;
}

void Segments::list(int block_row, bool top) {
  segments_.clear();
  for (int column = 0; column < grid_.columns; ++column) {
    if (!coded(column, block_row)) continue;
    const int begin = column * kBlockSide;
    const int end = std::min(begin + kBlockSide, grid_.width);
    const bool north = !top || coded(column, block_row - 1);
    const bool follows = !segments_.empty() && segments_.back().end == begin;
    if (follows && segments_.back().north == north) {
      segments_.back().end = end;
    } else {
      segments_.push_back({begin, end, north, follows});
    }
  }
}

const std::vector<Segment>& Segments::of_row(int row) {
  // All rows of whole images but the first are alike.
  const int block_row = mask_ == nullptr ? std::min(row, 1) : row / kBlockSide;
  const int in_block =
      mask_ == nullptr ? 1
                       : std::min(row % kBlockSide, 1);  // all rows but a block's first are alike
  const int key = 2 * block_row + in_block;
  if (key != listed_row_) list(block_row, in_block == 0);
  listed_row_ = key;
  return segments_;
}

}  // namespace rprr::dhcm
