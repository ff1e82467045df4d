// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// Nanoseconds on the steady clock, which is what timeouts run on: they must not follow a clock
/// that is set or a bag that starts again.
inline Stamp steady_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace rprr
