// SPDX-License-Identifier: BSD-3-Clause
#include "pose_broadcaster.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

#include "rprr_geometry_ros/conversions.hpp"
#include "transforms.hpp"

namespace rprr {
PoseBroadcaster::PoseBroadcaster(const Parameters& parameters, const tf2::BufferCore* buffer)
    : publish_(parameters.param("publish_tf", true)),
      root_(publishes_root(parameters)),
      buffer_(buffer) {
}

bool PoseBroadcaster::publishes_root(const Parameters& parameters) {
  return parameters.param("publish_tf", true) &&
         parameters.param<std::string>("tf_target", "own") == "root";
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
