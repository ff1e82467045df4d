// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/silence_watch.hpp"

#include <algorithm>

namespace rprr {
namespace {

constexpr double kLeastSilence = 3.0;  // [s]
constexpr double kIntervals = 4.0;
constexpr double kSmoothing = 0.3;

}  // namespace

void SilenceWatch::heard(const std::string& robot, SteadyTime now) {
  const auto known = robots_.find(robot);
  if (known == robots_.end()) {
    robots_[robot] = {now, 0.0};
    return;
  }
  Robot& watched = known->second;
  // A gap that was silence says nothing about the rate of frames.
  const double interval = to_seconds(now - watched.last);
  if (watched.interval == 0.0 || !silent_for(robot, now)) {
    watched.interval += kSmoothing * (interval - watched.interval);
  }
  watched.last = now;
}

std::optional<double> SilenceWatch::silent_for(const std::string& robot, SteadyTime now) const {
  const auto known = robots_.find(robot);
  if (known == robots_.end()) return {};
  const double seconds = to_seconds(now - known->second.last);
  if (seconds < std::max(kLeastSilence, kIntervals * known->second.interval)) return {};
  return seconds;
}

}  // namespace rprr
