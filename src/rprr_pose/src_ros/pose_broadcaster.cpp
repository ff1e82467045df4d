// SPDX-License-Identifier: BSD-3-Clause
#include "pose_broadcaster.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

#include "rprr_ros/conversions.hpp"
#include "transforms.hpp"

namespace rprr {
namespace {

constexpr int kLongestChain = 100;  // frames; nothing real comes near it

}  // namespace

std::string root_of(const tf2::BufferCore& buffer, const std::string& frame,
                    const std::string& above) {
  std::string root = frame;
  std::string parent;
  for (int i = 0; i < kLongestChain && buffer._getParent(root, ros::Time(0), parent); ++i) {
    if (parent.empty() || parent == above) break;
    root = parent;
  }
  return root;
}

PoseBroadcaster::PoseBroadcaster(const ExchangeNodeOptions& options, const tf2::BufferCore* buffer)
    : publish_(options.publish_tf), root_(options.publishes_root()), buffer_(buffer) {
}

void PoseBroadcaster::send(const RelativePoseMessage& pose, Health& health) {
  if (!publish_) return;
  geometry_msgs::TransformStamped message;
  Pose b_in_a = pose.b_from_a.inverse();
  message.child_frame_id = rebuilt_frame(pose.dependent);
  if (root_ && !to_root(pose, b_in_a, message.child_frame_id, health)) return;
  message.header.stamp = to_time(pose.dependent_stamp);
  message.header.frame_id = pose.frame_id;
  message.transform = to_transform(b_in_a);
  broadcaster_.sendTransform(message);
}

bool PoseBroadcaster::to_root(const RelativePoseMessage& pose, Pose& b_in_a, std::string& child,
                              Health& health) {
  const std::string& robot = pose.dependent;
  const std::string optical = optical_frame(robot);
  const std::string root = root_of(*buffer_, optical, pose.frame_id);
  try {
    const auto root_in_b = buffer_->lookupTransform(optical, root, ros::Time(0));
    b_in_a = b_in_a * from_transform(root_in_b.transform);
  } catch (const tf2::TransformException& error) {
    health.warn("tf of " + robot + " missing",
                "~tf_target is root, but " + optical + " is not in tf (" + error.what() +
                    "); publish the robot's tf here or set ~tf_target to own");
    return false;
  }
  child = root;
  return true;
}

}  // namespace rprr
