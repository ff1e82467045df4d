// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a block mask or a pair of them, and any bits as a mask that must come back.
#include "fuzz.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

using namespace rprr;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const BlockGrid grid(1 + data[0] * 5, 1 + data[1] * 3);
  const ByteView view(data + 2, size - 2);
  Bytes sealed(view.data, view.data + view.size);
  seal(sealed);
  for (const ByteView bytes : {view, ByteView(sealed)}) {
    const Result<BlockMask> mask = decode_mask(bytes, grid);
    if (mask) fuzz::require(mask->grid().count() == grid.count());
    const Result<BlockMaskPair> pair = decode_mask_pair(bytes, grid);
    if (pair) fuzz::require(is_subset(pair->depth, pair->colour));
  }
  if (view.size == 0) return 0;
  BlockMaskPair masks = {BlockMask(grid), BlockMask(grid)};
  for (int block = 0; block < grid.count(); ++block) {
    const unsigned byte = view.data[static_cast<std::size_t>(block / 4) % view.size];
    const unsigned bits = byte >> (block % 4 * 2) & 3u;
    masks.colour.set(block, bits != 0);
    masks.depth.set(block, bits == 3);
  }
  const Result<BlockMask> one = decode_mask(encode_mask(masks.colour), grid);
  fuzz::require(one && *one == masks.colour);
  const Result<BlockMaskPair> both = decode_mask_pair(encode_mask_pair(masks), grid);
  fuzz::require(both && both->colour == masks.colour && both->depth == masks.depth);
  return 0;
}
