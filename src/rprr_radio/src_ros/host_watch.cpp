// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio_ros/host_watch.hpp"

#include <algorithm>

namespace rprr {
namespace {

constexpr double kQuiet = 2.0;  // [s] a station's receipts come every second
constexpr Duration kProbePeriod = from_seconds(0.5);
constexpr Duration kIdlePeriod =
    from_seconds(5.0);                         // while the host answers but has nothing to say
constexpr Duration kGone = from_seconds(1.0);  // without an answer, at least
constexpr Duration kSlow = from_seconds(3.0);  // beyond it an answer is not slow but none
constexpr Duration kSurelyGone = from_seconds(5.0);
constexpr Duration kSettle = from_seconds(0.3);  // what is under way comes by itself

}  // namespace

HostWatch::Step HostWatch::step(double quiet, bool answered, SteadyTime now) {
  if (quiet < kQuiet) {
    on_bytes(now);
    return Step::kNothing;
  }
  if (renew_at_ && now >= *renew_at_) {
    renew_at_.reset();
    return Step::kRenew;
  }
  if (answered) return on_answer(now);
  if (renew_at_ || now < next_probe_) return Step::kNothing;
  if (!unanswered_since_) unanswered_since_ = now;
  next_probe_ = now + kProbePeriod;
  return Step::kProbe;
}

HostWatch::Step HostWatch::on_answer(SteadyTime now) {
  const Duration waited = unanswered_since_ ? now - *unanswered_since_ : 0;
  const bool was_gone = unanswered_since_ && waited >= gone_after();
  learn(waited);
  unanswered_since_.reset();
  next_probe_ = now + kIdlePeriod;
  if (was_gone) renew_at_ = now + kSettle;
  return Step::kNothing;
}

void HostWatch::on_bytes(SteadyTime now) {
  if (unanswered_since_) learn(now - *unanswered_since_);
  unanswered_since_.reset();
  renew_at_.reset();
  next_probe_ = {};
}

void HostWatch::learn(Duration waited) {
  if (waited < kSlow) slowest_ = std::max(waited, slowest_ - slowest_ / 8);
}

Duration HostWatch::gone_after() const {
  return std::clamp<Duration>(2 * slowest_, kGone, kSurelyGone);
}

double HostWatch::unanswered_for(SteadyTime now) const {
  const bool is_gone = unanswered_since_ && now - *unanswered_since_ >= gone_after();
  return is_gone ? to_seconds(now - *unanswered_since_) : 0.0;
}

}  // namespace rprr
