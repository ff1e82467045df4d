// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace rprr::dhcm {

/// Contexts: what is known of a pixel's surroundings before the pixel itself. Each has a Huffman
/// table of its own, which it may share with its predecessor in this list (doc/dhcm.md).
enum Context : int {
  kFlat = 0,    // no gradient within two columns: runs of right guesses
  kAlmostFlat,  // no gradient among the nearest neighbours: runs of right guesses
  kInHole,      // W, N and NE without reading: runs of no reading
  kRunContexts,
  kStep = kRunContexts,      // six contexts: one gradient of one rank, by its place and sign
  kActivity = kStep + 6,     // eight contexts by the sum of the gradients' sizes
  kHoleRim = kActivity + 8,  // six contexts: which of W, N and NE have no reading
  kNoNorth = kHoleRim + 6,   // first row of what is sent, W has a reading
  kNoNorthHole,              // first row of what is sent, W has none
  kStart,                    // first row, and nothing west of it either
  kPixelContexts,
  kRunTables = kPixelContexts,  // lengths of runs, one table for each run context
  kTables = kRunTables + kRunContexts
};

/// Median of W, N and W + N - NW: the planar guess, held between W and N.
inline int predict(int w, int n, int nw) {
  return std::clamp(w + n - nw, std::min(w, n), std::max(w, n));
}

/// Context of a pixel whose neighbours all have readings; ww and nee are the surface one column
/// further west and east of them.
inline int valid_context(int w, int n, int nw, int ne, int ww, int nee) {
  const int west = w - nw;
  const int north = n - nw;
  const int east = ne - n;
  const int activity = std::abs(west) + std::abs(north) + std::abs(east);
  if (activity == 0) return ww == w && nee == ne ? kFlat : kAlmostFlat;
  if (activity == 1) {
    const int place = west != 0 ? 0 : north != 0 ? 2 : 4;
    return kStep + place + (west + north + east < 0 ? 1 : 0);
  }
  static constexpr std::uint8_t kLevels[33] = {0, 0, 0, 1, 2, 2, 3, 3, 3, 4, 4, 4, 4, 4, 5, 5, 5,
                                               5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 7};
  return kActivity + kLevels[std::min(activity, 32)];
}

}  // namespace rprr::dhcm
