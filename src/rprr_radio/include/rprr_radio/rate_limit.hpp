// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// A byte budget as a token bucket: what is sent only when there is room for it keeps to
/// 2 * bytes_per_second over any two seconds. Bytes that others sent already, without asking, are
/// made up for by waiting longer. `now` is any steady time in nanoseconds.
class RateLimit {
 public:
  /// bytes_per_second: above 0.
  explicit RateLimit(double bytes_per_second) : rate_(bytes_per_second), tokens_(burst()) {}

  /// Bytes a second that are really used in the long run: burst() and two seconds of it are
  /// together two seconds of the whole rate.
  double steady_rate() const { return 0.9 * rate_; }
  /// Bytes that may go at once after a pause.
  double burst() const { return 0.2 * rate_; }

  /// Whether so many bytes may go now; more than a burst never may.
  bool has_room(std::size_t bytes, SteadyTime now) {
    return room(now) >= static_cast<double>(bytes);
  }
  /// Never more than two seconds are owed.
  void spend(std::size_t bytes, SteadyTime now) {
    tokens_ = std::max(room(now) - static_cast<double>(bytes), -2.0 * rate_);
  }
  /// When so many bytes, at most a burst, may go.
  SteadyTime room_at(std::size_t bytes, SteadyTime now) {
    const double missing = std::min(static_cast<double>(bytes), burst()) - room(now);
    return missing <= 0.0 ? now : now + from_seconds(missing / steady_rate()) + 1;
  }

 private:
  double room(SteadyTime now) {
    if (now > last_) {
      if (last_ != SteadyTime{}) tokens_ += steady_rate() * to_seconds(now - last_);
      tokens_ = std::min(tokens_, burst());
      last_ = now;
    }
    return tokens_;
  }

  double rate_;
  double tokens_;
  SteadyTime last_;
};

}  // namespace rprr
