// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_pose/preview_protocol.hpp"

namespace rprr {

/// Options of a reference that refers to frames near in time alone, whatever its radio does.
inline PreviewOptions near_in_time() {
  PreviewOptions options;
  options.reference_age = 0;
  return options;
}

}  // namespace rprr
