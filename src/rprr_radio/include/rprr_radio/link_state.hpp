// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// What a robot's exchanges need to know of its link to the station.
struct LinkState {
  /// One more frame can be sent; if not, no exchange should begin.
  bool has_room = true;
  /// Own whole frames that the station holds, the newest last. Where it sends no receipts: those
  /// that were sent.
  std::vector<Stamp> references;
  /// Time that a whole frame takes to the station [s]; 0: not known.
  double frame_seconds = 0.0;
};

}  // namespace rprr
