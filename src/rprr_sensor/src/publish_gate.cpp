// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/publish_gate.hpp"

#include <algorithm>

namespace rprr {
namespace {

constexpr int kMostTriggers = 100;

}  // namespace

void PublishGate::limit(int every_nth, double max_rate) {
  every_nth_ = std::max(every_nth, 1);
  period_ = max_rate > 0.0 ? from_seconds(1.0 / max_rate) : 0;
  skipped_ = every_nth_ - 1;
  due_ = 0;
}

void PublishGate::pause(bool paused) {
  paused_ = paused;
  triggered_ = 0;
  skipped_ = every_nth_ - 1;
}

bool PublishGate::trigger() {
  if (!paused_) return false;
  triggered_ = std::min(triggered_ + 1, kMostTriggers);
  return true;
}

bool PublishGate::pass(Stamp stamp) {
  if (stamp < last_) due_ = 0;
  last_ = stamp;
  if (paused_) {
    if (triggered_ == 0) return false;
    --triggered_;
    return true;
  }
  if (++skipped_ < every_nth_ || !on_time(stamp)) return false;
  skipped_ = 0;
  return true;
}

bool PublishGate::on_time(Stamp stamp) {
  if (period_ == 0) return true;
  // Frames jitter: one that comes slightly early is not left out, and the mean rate still holds.
  const Duration slack = std::min(period_ / 4, from_seconds(0.005));
  if (stamp < due_) return false;
  due_ = std::max(due_ + period_, stamp + period_ - slack);
  return true;
}

}  // namespace rprr
