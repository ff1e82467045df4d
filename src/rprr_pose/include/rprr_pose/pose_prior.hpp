// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// The frames of two robots, by stamp and optical frame. b's come over the radio: untrusted.
struct FrameNames {
  Stamp a_stamp = 0;
  std::string a_frame_id;
  Stamp b_stamp = 0;
  std::string b_frame_id;
};

/// A pose that was accepted earlier.
struct KnownPose {
  FrameNames frames;
  Pose b_from_a = Pose::Identity();  // the paper's M_ab
};

/// What else a robot knows of the pose to a peer (tf, odometry): M_ab of the frames worth trying
/// before a search, the likeliest first; none is fine. `last` is the pose accepted last, however
/// long ago. Nothing proposed is believed: it is refined and verified like the outcome of a search,
/// at one to two milliseconds each. Called on the director's thread; must not block.
using PosePrior = std::function<std::vector<Pose>(const std::string& peer, const FrameNames& frames,
                                                  const std::optional<KnownPose>& last)>;

}  // namespace rprr
