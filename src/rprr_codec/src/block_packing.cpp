// SPDX-License-Identifier: BSD-3-Clause
#include "block_packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"

namespace rprr {
namespace {

constexpr int kEven = 2;

// Where each line of blocks goes, -1 where it is taken out; returns how many stay.
int renumber(std::vector<int>& lines) {
  int next = 0;
  for (int& line : lines) line = line == 0 ? -1 : next++;
  return next;
}

std::vector<int> blocks_of(const BlockMask& mask) {
  std::vector<int> blocks;
  for (int block = 0; block < mask.grid().count(); ++block) {
    if (mask[block]) blocks.push_back(block);
  }
  return blocks;
}

// The first column and row of a region's rectangle, and its end.
struct Region {
  cv::Point first;
  cv::Point end;
  cv::Point moved;

  int width() const { return end.x - first.x; }
  int height() const { return end.y - first.y; }
};

int even_below(int line) {
  return line - line % kEven;
}

// Labels the region that holds a block and returns its rectangle.
Region flood(const BlockMask& mask, int start, int label, std::vector<int>& labels) {
  const BlockGrid& grid = mask.grid();
  Region region = {{grid.columns, grid.rows}, {0, 0}, {}};
  std::vector<int> open = {start};
  labels[static_cast<std::size_t>(start)] = label;
  while (!open.empty()) {
    const cv::Point at(open.back() % grid.columns, open.back() / grid.columns);
    open.pop_back();
    region.first = {std::min(region.first.x, even_below(at.x)),
                    std::min(region.first.y, even_below(at.y))};
    region.end = {std::max(region.end.x, even_below(at.x) + kEven),
                  std::max(region.end.y, even_below(at.y) + kEven)};
    for (int y = std::max(at.y - 1, 0); y <= std::min(at.y + 1, grid.rows - 1); ++y) {
      for (int x = std::max(at.x - 1, 0); x <= std::min(at.x + 1, grid.columns - 1); ++x) {
        int& other = labels[static_cast<std::size_t>(grid.index(x, y))];
        if (!mask[grid.index(x, y)] || other >= 0) continue;
        other = label;
        open.push_back(grid.index(x, y));
      }
    }
  }
  return region;
}

// Sets where each region goes; returns the size of all.
cv::Size put_on_shelves(std::vector<Region>& regions) {
  std::vector<Region*> order;
  double area = 0.0;
  int width = 0;
  for (Region& region : regions) {
    order.push_back(&region);
    area += static_cast<double>(region.width()) * region.height();
    width = std::max(width, region.width());
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Region* a, const Region* b) { return a->height() > b->height(); });
  width = std::max(width, static_cast<int>(std::ceil(std::sqrt(area))));
  cv::Size size;
  cv::Point next;
  for (Region* region : order) {
    if (next.x + region->width() > width) next = {0, size.height};
    region->moved = next;
    next.x += region->width();
    size = {std::max(size.width, next.x), std::max(size.height, next.y + region->height())};
  }
  return size;
}

}  // namespace

BlockPacking without_empty_lines(const BlockMask& mask) {
  const BlockGrid& grid = mask.grid();
  std::vector<int> columns(static_cast<std::size_t>(grid.columns), 0);
  std::vector<int> rows(static_cast<std::size_t>(grid.rows), 0);
  BlockPacking packing;
  packing.blocks = blocks_of(mask);
  for (const int block : packing.blocks) {
    columns[static_cast<std::size_t>(block % grid.columns)] = 1;
    rows[static_cast<std::size_t>(block / grid.columns)] = 1;
  }
  packing.size.width = renumber(columns);
  packing.size.height = renumber(rows);
  for (const int block : packing.blocks) {
    packing.to.emplace_back(columns[static_cast<std::size_t>(block % grid.columns)],
                            rows[static_cast<std::size_t>(block / grid.columns)]);
  }
  return packing;
}

BlockPacking on_shelves(const BlockMask& mask) {
  const BlockGrid& grid = mask.grid();
  BlockPacking packing;
  packing.blocks = blocks_of(mask);
  std::vector<int> labels(static_cast<std::size_t>(grid.count()), -1);
  std::vector<Region> regions;
  for (const int block : packing.blocks) {
    if (labels[static_cast<std::size_t>(block)] >= 0) continue;
    regions.push_back(flood(mask, block, static_cast<int>(regions.size()), labels));
  }
  packing.size = put_on_shelves(regions);
  for (const int block : packing.blocks) {
    const auto label = static_cast<std::size_t>(labels[static_cast<std::size_t>(block)]);
    const Region& region = regions[label];
    packing.to.push_back(cv::Point(block % grid.columns, block / grid.columns) - region.first +
                         region.moved);
  }
  return packing;
}

BlockPacking packed(const BlockMask& mask) {
  BlockPacking lines = without_empty_lines(mask);
  BlockPacking shelves = on_shelves(mask);
  const auto area = [](const BlockPacking& p) {
    return static_cast<std::int64_t>(p.size.width) * p.size.height;
  };
  const bool is_image =
      std::max(shelves.size.width, shelves.size.height) <= kMaxImageSide / kBlockSide;
  return is_image && 5 * area(shelves) <= 4 * area(lines) ? std::move(shelves) : std::move(lines);
}

}  // namespace rprr
