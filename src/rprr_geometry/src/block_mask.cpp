// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"

#include <algorithm>
#include <numeric>

namespace rprr {

int BlockMask::count() const {
  return std::accumulate(bits_.begin(), bits_.end(), 0);
}

BlockMask& BlockMask::operator|=(const BlockMask& other) {
  for (std::size_t i = 0; i < std::min(bits_.size(), other.bits_.size()); ++i) {
    bits_[i] |= other.bits_[i];
  }
  return *this;
}

bool BlockMask::operator==(const BlockMask& other) const {
  return grid_.width == other.grid_.width && grid_.height == other.grid_.height &&
         bits_ == other.bits_;
}

cv::Mat BlockMask::to_image() const {
  cv::Mat image(grid_.height, grid_.width, CV_8UC1, cv::Scalar(0));
  for (int block = 0; block < grid_.count(); ++block) {
    if ((*this)[block]) image(grid_.rect(block)).setTo(255);
  }
  return image;
}

bool is_subset(const BlockMask& inner, const BlockMask& outer) {
  const BlockGrid& grid = outer.grid();
  if (inner.grid().width != grid.width || inner.grid().height != grid.height) return false;
  for (int block = 0; block < grid.count(); ++block) {
    if (inner[block] && !outer[block]) return false;
  }
  return true;
}

}  // namespace rprr
