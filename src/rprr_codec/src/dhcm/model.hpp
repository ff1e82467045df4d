// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace rprr::dhcm {

/// Contexts: what the decoder knows of a pixel's neighbours before it reads the pixel. Each context
/// counts its own runs of right guesses and has its own Huffman tables. It may share the tables
/// with the context before it in this list (doc/dhcm.md, "Contexts"). W, N, NW, NE and NEE are the
/// neighbours to the west, the north and so on.
enum Context : int {
  kFlat = 0,                 // no gradient within two columns of the pixel
  kInHole,                   // W, N and NE without reading
  kAlmostFlat,               // no gradient among the nearest neighbours
  kStep,                     // six contexts: one gradient of one rank, by its place and sign
  kActivity = kStep + 6,     // eight contexts by the sum of the gradients' sizes
  kHoleRim = kActivity + 8,  // six contexts: which of W, N and NE have no reading
  kNoNorth = kHoleRim + 6,   // first row of what is sent, W has a reading
  kNoNorthHole,              // first row of what is sent, W has none
  kStart,                    // first row of what is sent, and nothing is sent to the west
  kContexts
};

/// Class of a pixel by the row above: by the gradients N - NW and NE - N, and by whether N and NE
/// are holes (pixels without reading).
enum NorthClass : std::uint8_t {
  kNorthPair = 0,       // nine: both gradients within -1..1
  kNorthLevel = 4,      // the pair (0, 0)
  kNorthFlat = 9,       // the pair (0, 0), and NEE equals NE
  kNorthActivity = 10,  // seven: by the sum of the gradients' sizes
  kNorthRim = 17,       // two: either N or NE is a hole
  kNorthHole = 19,      // N and NE are holes
  kNorthClasses
};

/// Class of a pixel by its west: W - NW held within -7..7, plus kWestLevel; or W is a hole.
constexpr int kWestHole = 0;
constexpr int kWestLevel = 8;
constexpr int kWestClasses = 16;

/// The context of every pair of a north class and a west class, row by row.
using ContextMap = std::array<std::uint8_t, kNorthClasses * kWestClasses>;
const ContextMap& context_map();

/// Median of W, N and W + N - NW, all modulo 2^16 and compared as signed numbers: the planar guess,
/// held between W and N. north_step is N - NW.
inline std::int16_t predict(std::int16_t w, std::int16_t n, std::int16_t north_step) {
  const auto plane = static_cast<std::int16_t>(w + north_step);
  const std::int16_t low = std::min(w, n);
  const std::int16_t high = std::max(w, n);
  const std::int16_t held = plane < low ? low : plane;
  return held > high ? high : held;
}

inline int west_class(std::int16_t w, std::int16_t nw) {
  const auto step = static_cast<std::int16_t>(w - nw);
  return std::clamp<int>(step, -7, 7) + kWestLevel;
}

/// North classes and steps of the pixels from begin to end of a row, from the surface above: fill
/// from column begin - 1 to end + 1, hole (0 or 1) from begin to end. Reads and writes up to
/// kLanes - 1 columns further, whose results mean nothing.
void classify_north(const std::int16_t* fill, const std::int16_t* hole, int begin, int end,
                    std::uint8_t* north, std::int16_t* step);
/// classify_north() for one pixel, which tests compare with. n: the surface above the pixel.
std::uint8_t north_class(const std::int16_t* n, const std::int16_t* hole);

/// Rows of numbers that a row of pixels is predicted from, by column. fill and hole are valid from
/// column begin - 1 on.
struct RowView {
  const std::int16_t* fill;
  const std::int16_t* hole;
  const std::int16_t* above;  // the surface of the row above
  const std::int16_t* step;   // from classify_north
  const std::uint8_t* north;
};
/// For each pixel from begin to end: its place in the context map, its residual, and whether the
/// guess failed (0 or 1). Precondition: the arrays have classify_north's margin.
void compare_row(const RowView& row, int begin, int end, std::int16_t* place,
                 std::int16_t* residual, std::uint8_t* miss);

}  // namespace rprr::dhcm
