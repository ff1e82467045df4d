// SPDX-License-Identifier: BSD-3-Clause
#include "pose_broadcaster.hpp"

#include <geometry_msgs/TransformStamped.h>

#include "rprr_geometry_ros/conversions.hpp"

namespace rprr {
namespace {

Pose from_transform(const geometry_msgs::Transform& transform) {
  return make_pose(
      {transform.translation.x, transform.translation.y, transform.translation.z},
      {transform.rotation.x, transform.rotation.y, transform.rotation.z, transform.rotation.w});
}

geometry_msgs::Transform to_transform(const Pose& pose) {
  geometry_msgs::Transform transform;
  const Eigen::Quaterniond q(pose.linear());
  transform.translation.x = pose.translation().x();
  transform.translation.y = pose.translation().y();
  transform.translation.z = pose.translation().z();
  transform.rotation.x = q.x();
  transform.rotation.y = q.y();
  transform.rotation.z = q.z();
  transform.rotation.w = q.w();
  return transform;
}

}  // namespace

PoseBroadcaster::PoseBroadcaster(const ros::NodeHandle& private_nh)
    : publish_(private_nh.param("publish_tf", true)),
      root_(private_nh.param<std::string>("tf_target", "own") == "root") {
  if (!publish_ || !root_) return;
  buffer_ = std::make_unique<tf2_ros::Buffer>();
  listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_);
}

void PoseBroadcaster::send(const RelativePoseMessage& pose, Health& health) {
  if (!publish_) return;
  geometry_msgs::TransformStamped message;
  Pose b_in_a = pose.motion.inverse();
  message.child_frame_id = rebuilt_frame(pose.dependent);
  if (root_ && !to_root(pose.dependent, b_in_a, message.child_frame_id, health)) return;
  message.header.stamp = to_time(pose.dependent_stamp);
  message.header.frame_id = pose.frame_id;
  message.transform = to_transform(b_in_a);
  broadcaster_.sendTransform(message);
}

bool PoseBroadcaster::to_root(const std::string& robot, Pose& b_in_a, std::string& child,
                              Health& health) {
  const std::string optical = optical_frame(robot);
  std::string root = optical;
  std::string parent;
  while (buffer_->_getParent(root, ros::Time(0), parent)) root = parent;
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
