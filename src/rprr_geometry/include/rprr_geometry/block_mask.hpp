// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/block_grid.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/wire.hpp"

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

/// Wire form of a mask, sealed with a CRC-32. Version 1:
///   u8 version, u16 image width, u16 image height, u8 mode (0 none, 1 all, 2 coded),
///   coded: adaptive binary range code over blocks in row order, context W, NW, N, NE.
/// A VGA mask takes about 60 to 200 bytes.
Bytes encode_mask(const BlockMask& mask);

/// The mask of an image of exactly the grid's size. Errors: anything malformed, another size.
Result<BlockMask> decode_mask(ByteView bytes, const BlockGrid& expected);

}  // namespace rprr
