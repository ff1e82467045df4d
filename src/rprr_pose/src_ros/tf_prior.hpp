// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2/buffer_core.h>

#include <optional>
#include <string>
#include <vector>

#include "rprr_pose/pose_prior.hpp"

namespace rprr {

struct TfPriorOptions {
  std::string robot;        // a
  std::string peer;         // b
  std::string fixed_frame;  // above both cameras; empty: the root of their tree, if they share one
  std::string odom_frame;  // above one camera, {robot} stands for its robot; empty: its tree's root
  bool publishes_root = false;  // our own poses hang the root of b's tree under a's optical frame
};

/// What tf knows of two robots' relative pose, as a PosePrior: the last accepted pose carried on
/// by each robot's odometry, and the pose through a tree in which both cameras hang. Never waits;
/// what tf does not know is not proposed. Poses that we published ourselves are no evidence: the
/// way is cut there. One thread at a time; the buffer has its own lock and must outlive this.
class TfPrior {
 public:
  TfPrior(const tf2::BufferCore& buffer, TfPriorOptions options);

  /// M_ab, the likeliest first: carried, then through the tree.
  std::vector<Pose> propose(const FrameNames& frames, const std::optional<KnownPose>& last);

  /// What was configured explicitly and is missing in tf, once; empty if nothing is.
  std::string take_complaint();

 private:
  using Chain = std::vector<std::string>;  // a frame, its parent, ... its root

  // A camera in a frame above it, remembered for longer than tf does.
  struct Remembered {
    Stamp stamp = 0;
    std::string camera, above;
    std::optional<Pose> pose;  // camera to above
  };

  std::optional<Pose> lookup(const std::string& target, const std::string& source, Stamp at) const;
  Chain chain_of(const std::string& frame, const std::string& a_frame) const;
  std::optional<Pose> through_tree(const FrameNames& frames, const Chain& a, const Chain& b);
  std::optional<Pose> carried(const FrameNames& frames, const KnownPose& last, const Chain& a,
                              const Chain& b);
  std::optional<Pose> moved(const std::string& robot, const Chain& chain, Stamp then, Stamp now,
                            Remembered& memory);

  const tf2::BufferCore& buffer_;
  const TfPriorOptions options_;
  Remembered a_then_, b_then_;
  std::string complaint_;
};

}  // namespace rprr
