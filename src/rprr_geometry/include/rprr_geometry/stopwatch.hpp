// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace rprr {

/// Wall time since it was made, for what stages report of themselves.
class Stopwatch {
 public:
  float milliseconds() const {
    return std::chrono::duration<float, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace rprr
