// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// The time of the steady clock, which timeouts run on: they must not follow a clock that is set or
/// a bag that starts again.
inline SteadyTime steady_now() {
  return SteadyTime(std::chrono::duration_cast<std::chrono::nanoseconds>(
                        std::chrono::steady_clock::now().time_since_epoch())
                        .count());
}

}  // namespace rprr
