// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/strips.hpp"

#include <algorithm>
#include <cstring>

#include "dhcm/tables.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr::dhcm {
namespace {

bool is_sent(const BlockGrid& grid, const BlockMask* mask, int column, int strip) {
  return mask == nullptr || (*mask)[grid.index(column, strip)];
}

}  // namespace

void list_segments(const BlockGrid& grid, const BlockMask* mask, int strip,
                   std::vector<StripSegment>& segments) {
  segments.clear();
  for (int column = 0; column < grid.columns; ++column) {
    if (!is_sent(grid, mask, column, strip)) continue;
    if (segments.empty() || segments.back().end != column) segments.push_back({column, column});
    ++segments.back().end;
  }
}

void StripSurface::reset(int columns) {
  fill.assign(static_cast<std::size_t>(columns) * kLanes, 0);
  holes.assign(static_cast<std::size_t>(columns), 0);
  last = 0;
}

void StripSurface::prepare(const BlockGrid& grid, const BlockMask* mask, int strip,
                           const StripSegment& segment) {
  if (mask == nullptr || strip == 0) return;
  for (int column = segment.begin; column < segment.end; ++column) {
    if (is_sent(grid, mask, column, strip - 1)) continue;
    std::int16_t* const first = fill.data() + static_cast<std::ptrdiff_t>(column) * kLanes;
    std::fill_n(first, kLanes, column == segment.begin ? last : first[-1]);
    holes[static_cast<std::size_t>(column)] = 0;
  }
}

}  // namespace rprr::dhcm
