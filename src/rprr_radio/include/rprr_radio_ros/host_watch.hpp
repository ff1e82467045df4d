// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// Finds out when a host that was out of reach can be reached again, by the bytes that come from it
/// and, while none come, by probes. Then connections to it are better made anew: TCP doubles its
/// waiting with every loss, so what was sent into the silence may lie for as long again as that
/// lasted. Where answers are slow, on a narrow radio, it takes longer to think a host gone. A state
/// machine without a clock; `now` is any steady time in nanoseconds.
class HostWatch {
 public:
  enum class Step {
    kNothing,
    kProbe,  // ask the host for a sign of life
    kRenew,  // it can be reached again, and the old connections are still silent
  };

  /// To be called some times a second. quiet: seconds since bytes came on any connection that is
  /// open to the host; answered: a probe was answered since the last call.
  Step step(double quiet, bool answered, SteadyTime now);

  /// Seconds for which the host has answered no probe; 0 if there is no reason to think it gone.
  double unanswered_for(SteadyTime now) const;

 private:
  Step on_answer(SteadyTime now);
  void on_bytes(SteadyTime now);
  void learn(Duration waited);
  Duration gone_after() const;

  std::optional<SteadyTime> unanswered_since_;
  std::optional<SteadyTime> renew_at_;
  SteadyTime next_probe_;
  Duration slowest_ = from_seconds(1.0);  // answer so far, forgotten by and by; a guess at first
};

}  // namespace rprr
