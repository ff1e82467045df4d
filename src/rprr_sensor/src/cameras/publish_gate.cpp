// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/publish_gate.hpp"

#include <algorithm>

namespace rprr {
namespace {

constexpr int kMostTriggers = 100;

}  // namespace

void PublishGate::limit(int every_nth, double max_rate) {
  every_nth_ = std::max(every_nth, 1);
  period_ = max_rate > 0.0 ? from_seconds(1.0 / max_rate) : 0;
  skipped_ = every_nth_ - 1;
  last_slot_ = -1;
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
  if (stamp < last_seen_) last_slot_ = -1;
  last_seen_ = stamp;
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
  const std::int64_t slot = stamp / period_;
  // Frames jitter: one that comes slightly early takes the next period's place, so that a camera
  // which is no faster than the rate loses nothing.
  const Duration slack = std::min(period_ / 4, from_seconds(0.005));
  const bool early = slot == last_slot_ && stamp - last_passed_ >= period_ - slack;
  if (slot <= last_slot_ && !early) return false;
  last_slot_ = early ? slot + 1 : slot;
  last_passed_ = stamp;
  return true;
}

}  // namespace rprr
