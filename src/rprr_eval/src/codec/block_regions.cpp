// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/codec/block_regions.hpp"
#include "rprr_geometry/block_mask.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace rprr {
namespace {

// Free neighbours of a block join the rim.
void add_neighbours(const BlockMask& mask, int block, std::vector<int>& rim) {
  const BlockGrid& grid = mask.grid();
  const int column = block % grid.columns;
  const int row = block / grid.columns;
  const auto add = [&](bool inside, int neighbour) {
    if (inside && !mask[neighbour]) rim.push_back(neighbour);
  };
  add(column > 0, block - 1);
  add(column + 1 < grid.columns, block + 1);
  add(row > 0, block - grid.columns);
  add(row + 1 < grid.rows, block + grid.columns);
}

// Grows one region by so many blocks, or until it is walled in; returns how many it got.
int grow(BlockMask& mask, int blocks, std::mt19937& random) {
  std::vector<int> rim;
  int grown = 0;
  while (grown < blocks) {
    if (rim.empty()) {
      if (grown > 0) return grown;
      const int start = static_cast<int>(random() % static_cast<unsigned>(mask.grid().count()));
      if (!mask[start]) rim.push_back(start);
      continue;
    }
    const std::size_t pick = random() % rim.size();
    const int block = rim[pick];
    rim[pick] = rim.back();
    rim.pop_back();
    if (mask[block]) continue;
    mask.set(block);
    ++grown;
    add_neighbours(mask, block, rim);
  }
  return grown;
}

}  // namespace

BlockMask random_regions(const BlockGrid& grid, double share, int regions, std::uint32_t seed) {
  std::mt19937 random(seed);
  BlockMask mask(grid);
  const int wanted =
      std::clamp(static_cast<int>(std::lround(share * grid.count())), 1, std::max(1, grid.count()));
  const int each = std::max(1, wanted / std::max(1, regions));
  for (int left = wanted; left > 0;) left -= grow(mask, std::min(each, left), random);
  return mask;
}

}  // namespace rprr
