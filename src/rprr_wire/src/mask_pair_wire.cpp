// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/mask_wire.hpp"

#include <array>

#include "mask_contexts.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/range_coder.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersionOfOneMask = 1;
constexpr std::uint8_t kVersion = 2;
using Contexts = std::array<AdaptiveBit, 16>;

AdaptiveBit& at(Contexts& contexts, int context) {
  return contexts[static_cast<std::size_t>(context)];
}

Bytes encode_bits(const BlockMaskPair& masks, MaskMode colour, MaskMode depth) {
  const BlockGrid& grid = masks.colour.grid();
  RangeEncoder encoder;
  if (colour == kMaskCoded) {
    Contexts contexts;
    for_each_with_context(grid, masks.colour, [&](int block, int context) {
      encoder.put(at(contexts, context), masks.colour[block]);
    });
  }
  if (depth == kMaskCoded) {
    Contexts contexts;
    for_each_with_context(grid, masks.depth, [&](int block, int context) {
      if (masks.colour[block]) encoder.put(at(contexts, context), masks.depth[block]);
    });
  }
  return encoder.finish();
}

// False where bytes are left over.
bool decode_bits(ByteView payload, MaskMode colour, MaskMode depth, BlockMaskPair& masks) {
  const BlockGrid& grid = masks.colour.grid();
  RangeDecoder decoder(payload);
  if (colour == kMaskCoded) {
    Contexts contexts;
    for_each_with_context(grid, masks.colour, [&](int block, int context) {
      masks.colour.set(block, decoder.get(at(contexts, context)));
    });
  }
  if (depth == kMaskCoded) {
    Contexts contexts;
    for_each_with_context(grid, masks.depth, [&](int block, int context) {
      if (masks.colour[block]) masks.depth.set(block, decoder.get(at(contexts, context)));
    });
  }
  return decoder.read_all();
}

}  // namespace

Bytes encode_mask_pair(const BlockMaskPair& masks) {
  if (masks.depth == masks.colour) return encode_mask(masks.colour);
  const BlockGrid& grid = masks.colour.grid();
  // Depth outside of colour must not steer the contexts, since the decoder never sees it.
  BlockMaskPair inside{masks.colour, BlockMask(grid)};
  if (masks.depth.grid().count() == grid.count()) {
    for (int block = 0; block < grid.count(); ++block) {
      inside.depth.set(block, masks.depth[block] && masks.colour[block]);
    }
  }
  const int set = masks.colour.count();
  const MaskMode colour = set == 0 ? kMaskNone : set == grid.count() ? kMaskAll : kMaskCoded;
  const MaskMode depth = inside.depth.count() == 0 ? kMaskNone : kMaskCoded;
  ByteWriter writer;
  writer.put(kVersion);
  writer.put(static_cast<std::uint16_t>(grid.width));
  writer.put(static_cast<std::uint16_t>(grid.height));
  writer.put(static_cast<std::uint8_t>(colour));
  writer.put(static_cast<std::uint8_t>(depth));
  if (colour == kMaskCoded || depth == kMaskCoded) {
    writer.append(encode_bits(inside, colour, depth));
  }
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

Result<BlockMaskPair> decode_mask_pair(ByteView bytes, const BlockGrid& expected) {
  ByteReader reader(unseal(bytes));
  const auto version = reader.get<std::uint8_t>();
  if (version == kVersionOfOneMask) {
    Result<BlockMask> mask = decode_mask(bytes, expected);
    if (!mask) return Error{mask.reason()};
    return BlockMaskPair{*mask, *mask};
  }
  const int width = reader.get<std::uint16_t>();
  const int height = reader.get<std::uint16_t>();
  const auto colour = reader.get<std::uint8_t>();
  const auto depth = reader.get<std::uint8_t>();
  if (!reader.ok()) return Error{"block mask damaged or cut short"};
  if (version != kVersion) return Error{"block mask of an unknown version"};
  if (width != expected.width || height != expected.height) {
    return Error{"block mask for an image of another size"};
  }
  if (colour > kMaskCoded || (depth != kMaskNone && depth != kMaskCoded)) {
    return Error{"block mask in an unknown mode"};
  }
  if (colour != kMaskCoded && depth != kMaskCoded && reader.left() != 0) {
    return Error{"block mask with bytes left over"};
  }
  BlockMaskPair masks{BlockMask(expected, colour == kMaskAll), BlockMask(expected)};
  if (!decode_bits(reader.get_view(reader.left()), static_cast<MaskMode>(colour),
                   static_cast<MaskMode>(depth), masks)) {
    return Error{"block mask with bytes left over"};
  }
  return masks;
}

}  // namespace rprr
