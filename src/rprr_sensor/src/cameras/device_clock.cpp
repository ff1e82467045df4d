// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/device_clock.hpp"

#include <algorithm>

namespace rprr {
namespace {

constexpr Duration kLongestDelay = from_seconds(0.25);  // beyond it the clock has jumped
constexpr double kDrift = 2e-4;                         // of the clocks, at most

}  // namespace

Stamp DeviceClock::stamp(Duration device_time, Stamp arrival) {
  const Duration delay_now = arrival - device_time;
  const bool jumped = delay_now - offset_ > kLongestDelay || offset_ - delay_now > kLongestDelay ||
                      arrival < last_arrival_;
  if (!set_ || jumped) {
    offset_ = delay_now;
    set_ = true;
  } else {
    const auto elapsed = static_cast<double>(arrival - last_arrival_);
    offset_ = std::min(offset_ + static_cast<Duration>(kDrift * elapsed), delay_now);
  }
  last_arrival_ = arrival;
  return device_time + offset_;
}

Duration TickCounter::read(std::uint32_t ticks) {
  if (set_) total_ += static_cast<std::int32_t>(ticks - last_);
  set_ = true;
  last_ = ticks;
  return static_cast<Duration>(static_cast<double>(total_) * 1e9 / ticks_per_second_);
}

}  // namespace rprr
