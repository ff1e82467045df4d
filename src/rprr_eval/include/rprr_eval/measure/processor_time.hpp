// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace rprr {

/// Processor time of this process since it was made, milliseconds. Waiting does not count.
class ProcessorTime {
 public:
  double ms() const {
    return 1e3 * static_cast<double>(std::clock() - start_) / static_cast<double>(CLOCKS_PER_SEC);
  }

 private:
  std::clock_t start_ = std::clock();
};

}  // namespace rprr
