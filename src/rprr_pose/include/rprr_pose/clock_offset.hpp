// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// How far two robots' clocks are apart, from the times at which the messages of their exchanges
/// left and came: as NTP does, from a question and its answer (RFC 5905, section 8). Of the recent
/// exchanges the one with the shortest way there and back is believed. Each bounds the offset, so
/// that one which contradicts those before tells of a clock that was set.
class ClockOffset {
 public:
  struct Estimate {
    double offset = 0.0;       // seconds that the peer's clock is ahead of this one
    double uncertainty = 0.0;  // half of the way there and back [s]
  };

  /// there: when the question came, by the peer's clock, less when it left, by this robot's [s].
  /// back: when the answer came, by this robot's clock, less when it left, by the peer's [s].
  /// Errors: the peer may say anything; what makes no sense is ignored.
  void add(double there, double back, SteadyTime now);
  std::optional<Estimate> estimate(SteadyTime now);

 private:
  struct Sample {
    double there;
    double back;
    SteadyTime at;
  };
  static bool contradict(const Sample& one, const Sample& other);
  void forget_old(SteadyTime now);

  std::deque<Sample> samples_;
};

}  // namespace rprr
