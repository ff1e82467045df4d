// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "mask_contexts.hpp"
#include "rprr_geometry/range_coder.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 1;

}  // namespace

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

Bytes encode_mask(const BlockMask& mask) {
  const BlockGrid& grid = mask.grid();
  const int set = mask.count();
  const MaskMode mode = set == 0 ? kMaskNone : set == grid.count() ? kMaskAll : kMaskCoded;
  ByteWriter writer;
  writer.put(kVersion);
  writer.put(static_cast<std::uint16_t>(grid.width));
  writer.put(static_cast<std::uint16_t>(grid.height));
  writer.put(static_cast<std::uint8_t>(mode));
  if (mode == kMaskCoded) {
    std::array<AdaptiveBit, 16> bits;
    RangeEncoder encoder;
    for_each_with_context(grid, mask, [&](int block, int context) {
      encoder.put(bits[static_cast<std::size_t>(context)], mask[block]);
    });
    writer.append(encoder.finish());
  }
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

Result<BlockMask> decode_mask(ByteView bytes, const BlockGrid& expected) {
  ByteReader reader(unseal(bytes));
  const auto version = reader.get<std::uint8_t>();
  const int width = reader.get<std::uint16_t>();
  const int height = reader.get<std::uint16_t>();
  const auto mode = reader.get<std::uint8_t>();
  if (!reader.ok()) return Error{"block mask damaged or cut short"};
  if (version != kVersion) return Error{"block mask of an unknown version"};
  if (width != expected.width || height != expected.height) {
    return Error{"block mask for an image of another size"};
  }
  if (mode > kMaskCoded || (mode != kMaskCoded && reader.left() != 0)) {
    return Error{"block mask in an unknown mode"};
  }
  BlockMask mask(expected, mode == kMaskAll);
  if (mode == kMaskCoded) {
    std::array<AdaptiveBit, 16> bits;
    RangeDecoder decoder(reader.get_view(reader.left()));
    for_each_with_context(expected, mask, [&](int block, int context) {
      mask.set(block, decoder.get(bits[static_cast<std::size_t>(context)]));
    });
    if (!decoder.read_all()) return Error{"block mask with bytes left over"};
  }
  return mask;
}

}  // namespace rprr
