// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// What a robot's exchanges need to know of its link to the station.
struct LinkState {
  bool has_room = true;           ///< one more frame can be sent; if not, no exchange should begin
  std::vector<Stamp> references;  ///< own whole frames that the station holds, the newest last; where
                                  ///< it sends no receipts, those that were sent
  double frame_seconds = 0.0;     ///< time that a whole frame takes to the station [s]; 0: not known
};

}  // namespace rprr
