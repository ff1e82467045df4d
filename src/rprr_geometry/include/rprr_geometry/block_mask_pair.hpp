// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/block_mask.hpp"

namespace rprr {

/// Blocks whose colour counts, and of these the ones whose depth counts too.
struct BlockMaskPair {
  BlockMask colour;
  BlockMask depth;  // subset of colour, same grid
};

/// Whether both masks are of one grid and every block of inner is in outer.
bool is_subset(const BlockMask& inner, const BlockMask& outer);

/// Wire form of both masks, sealed with a CRC-32. Equal masks are written as one, in the very bytes
/// of encode_mask (version 1). Otherwise version 2:
///   u8 version, u16 image width, u16 image height, u8 mode of colour (0 none, 1 all, 2 coded),
///   u8 mode of depth (0 none, 2 coded), coded: one range code, colour as in version 1, then depth
///   for the blocks of colour only, with a context of W, NW, N, NE in depth.
/// Depth outside of colour has no form: such blocks are left out.
Bytes encode_mask_pair(const BlockMaskPair& masks);

/// Masks of an image of exactly the grid's size, either version; depth is always a subset of
/// colour. Errors: anything malformed, another size.
Result<BlockMaskPair> decode_mask_pair(ByteView bytes, const BlockGrid& expected);

}  // namespace rprr
