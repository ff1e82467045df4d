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

/// What else a robot knows of the pose to a peer (tf, odometry): initial guesses of b_from_a for
/// the frames, the likeliest first; none is fine. `last` is the pose that was accepted last,
/// however long ago. A guess is never accepted as it is: it is refined and verified like the
/// outcome of a search, at one to two milliseconds each. Threads: called on the director's; it must
/// not block.
using PosePrior = std::function<std::vector<Pose>(const std::string& peer, const FrameNames& frames,
                                                  const std::optional<KnownPose>& last)>;

}  // namespace rprr
