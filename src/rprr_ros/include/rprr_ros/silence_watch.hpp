// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "rprr_geometry/steady_time.hpp"

namespace rprr {

/// Notices when a robot that was heard is heard no more: much longer than between its frames so
/// far. `now` is any steady time in nanoseconds.
class SilenceWatch {
 public:
  /// A frame of that robot came.
  void heard(const std::string& robot, SteadyTime now);
  /// Seconds since its last frame, if that is too long; a robot that never spoke is not missed.
  std::optional<double> silent_for(const std::string& robot, SteadyTime now) const;

 private:
  struct Robot {
    SteadyTime last;
    double interval = 0.0;  // seconds between frames, smoothed
  };
  std::map<std::string, Robot> robots_;
};

}  // namespace rprr
