// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_ros/transform_broadcaster.h>

#include <string>

#include "rprr_pose/messages.hpp"
#include "rprr_pose/pose_options.hpp"
#include "rprr_ros/health.hpp"

namespace rprr {

/// The root of the tree in which the frame is, or what hangs below `above` where that lies between:
/// so the link to it that was published before is not climbed. Ends also where tf has a loop.
std::string root_of(const tf2::BufferCore& buffer, const std::string& frame,
                    const std::string& above);

/// Accepted poses as tf: <a>_rgb_optical_frame -> <b>_rprr_optical_frame, a frame of its own since
/// b's optical frame usually has a parent; or, with ~tf_target root, to the root of b's tree, so
/// that both robots hang together. tf2 stores b's pose in a, the inverse of M_ab.
class PoseBroadcaster {
 public:
  /// buffer: needed, and must outlive this, if options.publishes_root().
  PoseBroadcaster(const ExchangeNodeOptions& options, const tf2::BufferCore* buffer);
  /// health hears of missing tf.
  void send(const RelativePoseMessage& pose, Health& health);

 private:
  bool to_root(const RelativePoseMessage& pose, Pose& b_in_a, std::string& child, Health& health);

  bool publish_;
  bool root_;
  tf2_ros::TransformBroadcaster broadcaster_;
  const tf2::BufferCore* buffer_;  // only for the root
};

}  // namespace rprr
