// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/block_grid.hpp"

namespace rprr {

/// A set of the blocks of a grid (the paper's B_p, B_v and their union).
class BlockMask {
 public:
  BlockMask() = default;
  explicit BlockMask(const BlockGrid& grid, bool all = false)
      : grid_(grid), bits_(static_cast<std::size_t>(grid.count()), all ? 1 : 0) {}

  const BlockGrid& grid() const { return grid_; }
  bool operator[](int block) const { return bits_[static_cast<std::size_t>(block)] != 0; }
  void set(int block, bool value = true) { bits_[static_cast<std::size_t>(block)] = value ? 1 : 0; }
  bool empty() const { return bits_.empty(); }
  int count() const;

  /// Union with a mask of the same grid.
  BlockMask& operator|=(const BlockMask& other);
  bool operator==(const BlockMask& other) const;

  /// mono8 image of the grid's full size, 255 in the blocks of the set.
  cv::Mat to_image() const;

 private:
  BlockGrid grid_;
  std::vector<std::uint8_t> bits_;
};

/// Blocks whose colour counts, and of these the ones whose depth counts too.
struct BlockMaskPair {
  BlockMask colour;
  BlockMask depth;  // subset of colour, same grid
};

/// Whether both masks are of one grid and every block of inner is in outer.
bool is_subset(const BlockMask& inner, const BlockMask& outer);

}  // namespace rprr
