// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/clock_offset.hpp"

#include <algorithm>
#include <cmath>

namespace rprr {
namespace {

constexpr std::size_t kSamples = 32;
constexpr Duration kLongest = from_seconds(60.0);  // clocks of robots drift by some ms in that time
constexpr double kMostSeconds = 1e9;               // apart: a robot without a clock starts in 1970
constexpr double kLongestWay = 60.0;               // seconds there and back
constexpr double kDrift = 0.01;                    // [s] of clocks that are kept together

}  // namespace

void ClockOffset::add(double there, double back, SteadyTime now) {
  if (!(std::abs(there) < kMostSeconds && std::abs(back) < kMostSeconds)) return;
  const double way = there + back;
  if (way < 0.0 || way > kLongestWay) return;
  forget_old(now);
  const Sample sample{there, back, now};
  samples_.erase(
      std::remove_if(samples_.begin(), samples_.end(),
                     [&sample](const Sample& other) { return contradict(sample, other); }),
      samples_.end());
  samples_.push_back(sample);
  if (samples_.size() > kSamples) samples_.pop_front();
}

std::optional<ClockOffset::Estimate> ClockOffset::estimate(SteadyTime now) {
  forget_old(now);
  const auto best = std::min_element(samples_.begin(), samples_.end(),
                                     [](const Sample& one, const Sample& other) {
                                       return one.there + one.back < other.there + other.back;
                                     });
  if (best == samples_.end()) return std::nullopt;
  return Estimate{(best->there - best->back) / 2.0, (best->there + best->back) / 2.0};
}

// The offset is between -back and there.
bool ClockOffset::contradict(const Sample& one, const Sample& other) {
  return -one.back > other.there + kDrift || one.there + kDrift < -other.back;
}

void ClockOffset::forget_old(SteadyTime now) {
  while (!samples_.empty() && now - samples_.front().at > kLongest) samples_.pop_front();
}

}  // namespace rprr
