// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/mask_wire.hpp"

#include <array>

#include "mask_contexts.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/range_coder.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 1;

}  // namespace

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
