// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "rprr_pose/pose_verdict.hpp"

namespace rprr {

/// A float with the digits that it has, and none that the conversion to double makes up.
inline double shortened(float value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.7g", static_cast<double>(value));
  return std::strtod(text, nullptr);
}

/// {"status": "ambiguous", "quantity": "margin", "measured": 0.02, "needed": 0.06}; a figure that
/// is no number is null.
inline nlohmann::json to_json(const PoseVerdict& verdict) {
  return {{"status", name_of(verdict.status)},
          {"quantity", name_of(verdict.quantity)},
          {"measured", shortened(verdict.measured)},
          {"needed", shortened(verdict.needed)}};
}

}  // namespace rprr
