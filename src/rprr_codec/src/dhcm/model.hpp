// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace rprr::dhcm {

/// Contexts: what is known of a pixel's surroundings before the pixel itself. Each counts its runs
/// of right guesses for itself and has Huffman tables of its own, which it may share with its
/// predecessor in this list (doc/dhcm.md).
enum Context : int {
  kFlat = 0,                 // no gradient within two columns
  kInHole,                   // W, N and NE without reading
  kAlmostFlat,               // no gradient among the nearest neighbours
  kStep,                     // six contexts: one gradient of one rank, by its place and sign
  kActivity = kStep + 6,     // eight contexts by the sum of the gradients' sizes
  kHoleRim = kActivity + 8,  // six contexts: which of W, N and NE have no reading
  kNoNorth = kHoleRim + 6,   // first row of what is sent, W has a reading
  kNoNorthHole,              // first row of what is sent, W has none
  kStart,                    // first row, and nothing west of it either
  kContexts
};

/// What the row above says of a pixel, from N - NW, NE - N and which of N and NE are holes.
enum NorthClass : std::uint8_t {
  kNorthPair = 0,       // nine: both gradients within -1..1
  kNorthLevel = 4,      // the pair (0, 0)
  kNorthFlat = 9,       // the same, and NEE equals NE too
  kNorthActivity = 10,  // seven, by the sum of the sizes
  kNorthRim = 17,       // two: N or NE is a hole
  kNorthHole = 19,      // both are
  kNorthClasses
};

/// What the west adds: W - NW held within -7..7, or that W is a hole.
constexpr int kWestHole = 0;
constexpr int kWestLevel = 8;
constexpr int kWestClasses = 16;

/// Context by north class and west class.
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
/// The same for one pixel, for tests to compare with: n is the surface above it.
std::uint8_t north_class(const std::int16_t* n, const std::int16_t* hole);

/// What of a row of pixels is as guessed. All by column; fill and hole from column begin - 1.
struct RowView {
  const std::int16_t* fill;
  const std::int16_t* hole;
  const std::int16_t* above;  // the surface of the row above
  const std::int16_t* step;   // from classify_north
  const std::uint8_t* north;
};
/// Places in the context map, residuals and whether a guess failed (0 or 1), with the same margin
/// as classify_north.
void compare_row(const RowView& row, int begin, int end, std::int16_t* place,
                 std::int16_t* residual, std::uint8_t* miss);

}  // namespace rprr::dhcm
