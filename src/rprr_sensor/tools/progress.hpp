// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iostream>
#include <string>

namespace rprr {

/// "3 of 50 frames", kept up to date on standard error.
inline void show_progress(std::size_t done, std::size_t all) {
  std::cerr << '\r' << done << " of " << all << " frames" << (done == all ? "\n" : "")
            << std::flush;
}

/// Says what went wrong and gives the exit status.
inline int fail(const std::string& reason) {
  std::cerr << "\nerror: " << reason << std::endl;
  return 1;
}

}  // namespace rprr
