// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "dhcm/model.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr::dhcm {

/// Pixels of one row that are coded from left to right.
struct Segment {
  int begin = 0;
  int end = 0;
  bool north = false;  // the pixels above were coded
  bool west = false;   // the pixel before was coded
};

/// The segments of an image's rows: all of it, or the blocks of a mask.
class Segments {
 public:
  Segments(const BlockGrid& grid, const BlockMask* mask) : grid_(grid), mask_(mask) {}

  /// Called for ever larger rows; the answer is valid until the next call.
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

/// What a coder says of a pixel: its value, or kNoReading.
constexpr int kNoReading = -1;

/// The last known surface above each column, with a margin of two columns on either side. A pixel
/// that has no reading, or is not coded, keeps a guess of what would be there.
class Surface {
 public:
  static constexpr int kMargin = 2;
  void reset(int width) {
    fill_.assign(static_cast<std::size_t>(width + 2 * kMargin), 0);
    hole_.assign(fill_.size(), 0);
    last_start_ = 0;
  }
  int* fill() { return fill_.data() + kMargin; }
  std::uint8_t* hole() { return hole_.data() + kMargin; }
  /// The surface where a segment with no known neighbour began last.
  int& last_start() { return last_start_; }

 private:
  std::vector<int> fill_;
  std::vector<std::uint8_t> hole_;
  int last_start_ = 0;
};

/// A segment whose northern neighbours are known. Coder: int run(context, guess, u), for contexts
/// below kRunContexts, and int pixel(context, guess, u).
template <typename Coder>
void scan_below_known(const Segment& segment, Surface& surface, Coder& coder) {
  int* const fill = surface.fill();
  std::uint8_t* const hole = surface.hole();
  const int begin = segment.begin;
  const int end = segment.end;
  if (!segment.west) {
    fill[begin - 1] = fill[begin - 2] = fill[begin];
    hole[begin - 1] = hole[begin];
  }
  // Whatever stands there is not coded in this row, or nothing above it was.
  fill[end] = fill[end + 1] = fill[end - 1];
  hole[end] = hole[end - 1];
  int nw = fill[begin - 1];
  int w = nw;
  int n = fill[begin];
  int w_hole = hole[begin - 1];
  int n_hole = hole[begin];
  for (int u = begin; u < end; ++u) {
    const int ne = fill[u + 1];
    const int ne_hole = hole[u + 1];
    const int holes = w_hole | n_hole << 1 | ne_hole << 2;
    const int guess = predict(w, n, nw);
    int value = 0;
    if (holes == 0) {
      const int context = valid_context(w, n, nw, ne, fill[u - 2], fill[u + 2]);
      value =
          context < kRunContexts ? coder.run(context, guess, u) : coder.pixel(context, guess, u);
    } else if (holes == 7) {
      value = coder.run(kInHole, guess, u);
    } else {
      value = coder.pixel(kHoleRim + holes - 1, guess, u);
    }
    w_hole = value == kNoReading ? 1 : 0;
    w = value == kNoReading ? guess : value;
    fill[u] = w;
    hole[u] = static_cast<std::uint8_t>(w_hole);
    nw = n;
    n = ne;
    n_hole = ne_hole;
  }
}

/// The first row of what is sent: only the west is known, and nothing at all at its beginning.
template <typename Coder>
void scan_first_row(const Segment& segment, Surface& surface, Coder& coder) {
  int* const fill = surface.fill();
  std::uint8_t* const hole = surface.hole();
  for (int u = segment.begin; u < segment.end; ++u) {
    const bool start = u == segment.begin && !segment.west;
    const int guess = start ? surface.last_start() : fill[u - 1];
    const int context = start ? kStart : hole[u - 1] != 0 ? kNoNorthHole : kNoNorth;
    const int value = coder.pixel(context, guess, u);
    fill[u] = value == kNoReading ? guess : value;
    hole[u] = value == kNoReading ? 1 : 0;
    if (start) surface.last_start() = fill[u];
  }
}

template <typename Coder>
void scan_row(const std::vector<Segment>& segments, Surface& surface, Coder& coder) {
  for (const Segment& segment : segments) {
    if (segment.north) {
      scan_below_known(segment, surface, coder);
    } else {
      scan_first_row(segment, surface, coder);
    }
  }
}

}  // namespace rprr::dhcm
