// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {

InputTopics input_topics(const std::string& robot) {
  const std::string root = "/" + robot;
  return {root + "/camera/rgb/image_rect_color", root + "/camera/rgb/camera_info",
          root + "/camera/depth_registered/image_rect", root + "/ground_truth/pose"};
}

InputTopics tum_topics() {
  return {"/camera/rgb/image_color", "/camera/rgb/camera_info", "/camera/depth/image", ""};
}

geometry_msgs::PoseStamped pose_message(const ros::Time& stamp, const Pose& world_from_camera) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = "world";
  const Eigen::Quaterniond q(world_from_camera.rotation());
  message.pose.position.x = world_from_camera.translation().x();
  message.pose.position.y = world_from_camera.translation().y();
  message.pose.position.z = world_from_camera.translation().z();
  message.pose.orientation.x = q.x();
  message.pose.orientation.y = q.y();
  message.pose.orientation.z = q.z();
  message.pose.orientation.w = q.w();
  return message;
}

}  // namespace rprr
