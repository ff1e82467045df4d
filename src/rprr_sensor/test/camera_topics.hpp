// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {

/// All that one robot's camera published, by stamp.
struct CameraTopics {
  std::map<ros::Time, sensor_msgs::Image> colour;
  std::map<ros::Time, sensor_msgs::Image> depth;
  std::map<ros::Time, sensor_msgs::CameraInfo> info;
  std::map<ros::Time, geometry_msgs::PoseStamped> pose;
  std::vector<ros::Subscriber> subscribers;

  void listen(ros::NodeHandle& nh, const std::string& robot) {
    const InputTopics topics = input_topics(robot);
    subscribers = {nh.subscribe(topics.colour, 50, &CameraTopics::on_colour, this),
                   nh.subscribe(topics.depth, 50, &CameraTopics::on_depth, this),
                   nh.subscribe(topics.camera_info, 50, &CameraTopics::on_info, this),
                   nh.subscribe(topics.pose, 50, &CameraTopics::on_pose, this)};
  }
  void on_colour(const sensor_msgs::Image& m) { colour[m.header.stamp] = m; }
  void on_depth(const sensor_msgs::Image& m) { depth[m.header.stamp] = m; }
  void on_info(const sensor_msgs::CameraInfo& m) { info[m.header.stamp] = m; }
  void on_pose(const geometry_msgs::PoseStamped& m) { pose[m.header.stamp] = m; }
  std::size_t frames() const { return std::min({colour.size(), depth.size(), info.size()}); }
};

}  // namespace rprr
