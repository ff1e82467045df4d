// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "dhcm/lanes.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr::dhcm {

/// Pixels of one row that are coded from left to right.
struct Segment {
  int begin = 0;
  int end = 0;
  bool north = false;  // the pixels above were coded
  bool west = false;   // the pixel before was coded
};

/// The segments of each row of an image: one for the whole row, or those of a mask's blocks.
class Segments {
 public:
  Segments(const BlockGrid& grid, const BlockMask* mask) : grid_(grid), mask_(mask) {}

  /// Preconditions: rows are asked for in rising order. The answer is valid until the next call.
  const std::vector<Segment>& of_row(int row);
  /// Pixels that are coded in the whole image.
  std::size_t pixels() const;

 private:
  bool coded(int column, int row) const;
  void list(int block_row, bool top);

  BlockGrid grid_;
  const BlockMask* mask_;
  std::vector<Segment> segments_;
  int listed_row_ = -1;
};

/// The last known surface above each column. A pixel that has no reading, or is not coded, keeps a
/// guess of what would be there. Two columns of margin are on either side, and room for kLanes
/// more.
class Surface {
 public:
  static constexpr int kMargin = 2;
  void reset(int width) {
    fill_.assign(static_cast<std::size_t>(width + 2 * kMargin + kLanes), 0);
    hole_.assign(fill_.size(), 0);
    last_start_ = 0;
  }
  /// Rank or reading of each column, modulo 2^16.
  std::int16_t* fill() { return fill_.data() + kMargin; }
  /// Whether the pixel of each column had no reading: 0 or 1.
  std::int16_t* hole() { return hole_.data() + kMargin; }
  /// The surface where a segment with no known neighbour began last.
  std::int16_t& last_start() { return last_start_; }
  /// Fills in the columns beside a segment that its pixels are predicted from.
  void prepare(const Segment& segment) {
    std::int16_t* const f = fill();
    std::int16_t* const h = hole();
    if (!segment.west) {
      f[segment.begin - 1] = f[segment.begin];
      h[segment.begin - 1] = h[segment.begin];
    }
    // The column after the segment is not coded in this row, or had nothing coded above.
    f[segment.end] = f[segment.end + 1] = f[segment.end - 1];
    h[segment.end] = h[segment.end - 1];
  }

 private:
  std::vector<std::int16_t> fill_;
  std::vector<std::int16_t> hole_;
  std::int16_t last_start_ = 0;
};

}  // namespace rprr::dhcm
