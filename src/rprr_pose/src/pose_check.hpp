// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_pose/pose_verdict.hpp"

namespace rprr {

/// A check is one of the tests that a pose has to pass. The figures are compared as they were
/// measured: a verdict holds them rounded to floats.
struct PoseCheck {
  PoseStatus status_if_failed = PoseStatus::kAccepted;
  PoseQuantity quantity = PoseQuantity::kNone;
  double measured = 0.0;
  double needed = 0.0;

  /// A figure that is not a number fails no test: whoever measures sees to it that there is none.
  bool failed() const { return is_lower_limit(quantity) ? measured < needed : measured > needed; }
  PoseVerdict rejected() const {
    return make_verdict(status_if_failed, quantity, measured, needed);
  }
  PoseVerdict accepted() const {
    return make_verdict(PoseStatus::kAccepted, quantity, measured, needed);
  }
  /// Tells how near the figure came to its limit: 1 is on the limit, less is on its good side.
  double use_of_limit() const {
    return is_lower_limit(quantity) ? needed / measured : measured / needed;
  }
};

/// Finds the first check that failed. The pointer is null if all passed.
template <typename Checks>
const PoseCheck* first_failed(const Checks& checks) {
  for (const PoseCheck& check : checks) {
    if (check.failed()) return &check;
  }
  return nullptr;
}

}  // namespace rprr
