// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/block_mask.hpp"

namespace rprr {

/// How the wire forms of masks say how much of the grid is set.
enum MaskMode : std::uint8_t { kMaskNone = 0, kMaskAll = 1, kMaskCoded = 2 };

/// Visits blocks in row order with the context (0 to 15) that both ends know by then: W, NW, N, NE.
template <typename Visit>
void for_each_with_context(const BlockGrid& grid, const BlockMask& mask, const Visit& visit) {
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto bit = [&](int dc, int dr) {
        const int c = column + dc;
        const int r = row + dr;
        return c >= 0 && r >= 0 && c < grid.columns && mask[grid.index(c, r)] ? 1 : 0;
      };
      const int context = bit(-1, 0) | bit(-1, -1) << 1 | bit(0, -1) << 2 | bit(1, -1) << 3;
      visit(grid.index(column, row), context);
    }
  }
}

}  // namespace rprr
