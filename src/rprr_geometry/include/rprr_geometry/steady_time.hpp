// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// Time since a host started [ns]. Timeouts count by it: it never jumps. Steady times of two hosts
/// have nothing in common. It is a type of its own, so that it is never taken for a stamp.
class SteadyTime {
 public:
  constexpr SteadyTime() = default;
  constexpr explicit SteadyTime(Duration since_start) : since_start_(since_start) {}

  constexpr Duration since_start() const { return since_start_; }

  constexpr SteadyTime& operator+=(Duration duration) {
    since_start_ += duration;
    return *this;
  }
  friend constexpr SteadyTime operator+(SteadyTime time, Duration duration) {
    return SteadyTime(time.since_start_ + duration);
  }
  friend constexpr SteadyTime operator-(SteadyTime time, Duration duration) {
    return SteadyTime(time.since_start_ - duration);
  }
  friend constexpr Duration operator-(SteadyTime later, SteadyTime earlier) {
    return later.since_start_ - earlier.since_start_;
  }
  friend constexpr bool operator==(SteadyTime a, SteadyTime b) {
    return a.since_start_ == b.since_start_;
  }
  friend constexpr bool operator!=(SteadyTime a, SteadyTime b) { return !(a == b); }
  friend constexpr bool operator<(SteadyTime a, SteadyTime b) {
    return a.since_start_ < b.since_start_;
  }
  friend constexpr bool operator>(SteadyTime a, SteadyTime b) { return b < a; }
  friend constexpr bool operator<=(SteadyTime a, SteadyTime b) { return !(b < a); }
  friend constexpr bool operator>=(SteadyTime a, SteadyTime b) { return !(a < b); }

 private:
  Duration since_start_ = 0;
};

/// A time of a simulated clock.
constexpr SteadyTime steady_seconds(double since_start) {
  return SteadyTime(from_seconds(since_start));
}

}  // namespace rprr
