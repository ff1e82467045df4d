// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/silence_watch.hpp"

#include <algorithm>

namespace rprr {
namespace {

constexpr double kIntervals = 4.0;  // between messages: a longer silence is too long
constexpr double kSmoothing = 0.3;  // share of the newest interval in the smoothed one
constexpr double kFirst = 3.0;      // times the least silence, after a single message

}  // namespace

void SilenceWatch::heard(const std::string& name, SteadyTime now) {
  const auto known = heard_.find(name);
  if (known == heard_.end()) {
    heard_[name] = {now, 0.0};
    return;
  }
  Heard& watched = known->second;
  // A gap that was silence says nothing about the rate of messages.
  const double interval = to_seconds(now - watched.last);
  if (watched.interval == 0.0 || !silent_for(name, now)) {
    watched.interval += kSmoothing * (interval - watched.interval);
  }
  watched.last = now;
}

std::optional<double> SilenceWatch::silent_for(const std::string& name, SteadyTime now) const {
  const auto known = heard_.find(name);
  if (known == heard_.end()) return {};
  const double seconds = to_seconds(now - known->second.last);
  const double interval = known->second.interval;
  const double least = to_seconds(least_) * (interval == 0.0 ? kFirst : 1.0);
  if (seconds < std::max(least, kIntervals * interval)) return {};
  return seconds;
}

}  // namespace rprr
