// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_status.hpp"

namespace rprr {

const char* reason_of(PoseStatus status) {
  switch (status) {
    case PoseStatus::kAccepted:
      return "";
    case PoseStatus::kTimedOut:
      return "the peer fell silent";
    case PoseStatus::kTooFewPoints:
      return "too little valid depth";
    case PoseStatus::kNotConverged:
      return "not converged";
    case PoseStatus::kDegenerate:
      return "the geometry leaves a direction free";
    case PoseStatus::kLittleOverlap:
      return "too little overlap";
    case PoseStatus::kInconsistent:
      return "surfaces disagree";
    case PoseStatus::kFreeSpaceViolated:
      return "points lie in free space";
    case PoseStatus::kMalformed:
      return "the peer's message could not be read";
    case PoseStatus::kNoFrame:
      return "no frame of the reference is near in time: clocks differ, or its camera is stuck";
  }
  return "unknown status";
}

}  // namespace rprr
