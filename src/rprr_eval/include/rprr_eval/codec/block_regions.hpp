// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "rprr_geometry/block_mask.hpp"

namespace rprr {

/// So large a share of a grid's blocks (at least one) in a few regions that grow from random blocks
/// through their four neighbours, as missing parts of a view do. The same on every machine for the
/// same seed.
BlockMask random_regions(const BlockGrid& grid, double share, int regions, std::uint32_t seed);

}  // namespace rprr
