// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rprr {

/// Nanoseconds since the epoch of whoever made the stamp. Frames are named by their stamps.
using Stamp = std::int64_t;
/// Nanoseconds.
using Duration = std::int64_t;

constexpr Duration from_seconds(double seconds) {
  return static_cast<Duration>(seconds * 1e9);
}
constexpr double to_seconds(Duration duration) {
  return static_cast<double>(duration) * 1e-9;
}

}  // namespace rprr
