// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Wire form of a mask, sealed with a CRC-32. Version 1:
///   u8 version, u16 image width, u16 image height, u8 mode (0 none, 1 all, 2 coded),
///   coded: adaptive binary range code over blocks in row order, context W, NW, N, NE.
/// A VGA mask takes about 60 to 200 bytes.
Bytes encode_mask(const BlockMask& mask);

/// The mask of an image of exactly the grid's size. Errors: anything malformed, another size.
Result<BlockMask> decode_mask(ByteView bytes, const BlockGrid& expected);

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
