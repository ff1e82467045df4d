// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// Notices when something that was heard regularly, such as a robot's frames, is heard no more: for
/// much longer than between its messages so far.
class SilenceWatch {
 public:
  /// least: silences that are shorter are never too long. Of what was heard only once nobody knows
  /// how often it comes: it has three times as long.
  explicit SilenceWatch(Duration least = from_seconds(3.0)) : least_(least) {}

  /// A message of that name came.
  void heard(const std::string& name, SteadyTime now);
  /// Seconds since its last message, if that is too long; what was never heard is not missed.
  std::optional<double> silent_for(const std::string& name, SteadyTime now) const;

 private:
  struct Heard {
    SteadyTime last;
    double interval = 0.0;  // between messages, smoothed [s]
  };
  Duration least_;
  std::map<std::string, Heard> heard_;
};

}  // namespace rprr
