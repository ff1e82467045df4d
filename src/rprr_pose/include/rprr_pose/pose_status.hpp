// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rprr {

/// How an exchange ended. Values are those of rprr_msgs/RelativePose.
enum class PoseStatus : std::uint8_t {
  kAccepted = 0,
  kTimedOut = 1,
  kTooFewPoints = 2,
  kNotConverged = 3,
  kDegenerate = 4,
  kLittleOverlap = 5,
  kInconsistent = 6,
  kFreeSpaceViolated = 7,
  kMalformed = 8,
  kNoFrame = 9,
};

/// The same in words; empty for kAccepted. Values out of range say so.
const char* reason_of(PoseStatus status);

}  // namespace rprr
