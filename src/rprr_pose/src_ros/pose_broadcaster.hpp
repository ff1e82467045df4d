// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <string>

#include "rprr_geometry_ros/health.hpp"
#include "rprr_pose/messages.hpp"

namespace rprr {

/// Accepted poses as tf: <a>_rgb_optical_frame -> <b>_rprr_optical_frame, a frame of its own since
/// b's optical frame usually has a parent; or, with ~tf_target root, to the root of b's tree, so
/// that both robots hang together. tf2 stores b's pose in a, the inverse of M_ab.
class PoseBroadcaster {
 public:
  explicit PoseBroadcaster(const ros::NodeHandle& private_nh);
  /// health hears of missing tf.
  void send(const RelativePoseMessage& pose, Health& health);

 private:
  bool to_root(const std::string& robot, Pose& b_in_a, std::string& child, Health& health);

  bool publish_;
  bool root_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<tf2_ros::Buffer> buffer_;  // only for the root
  std::unique_ptr<tf2_ros::TransformListener> listener_;
};

}  // namespace rprr
