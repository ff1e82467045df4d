// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "rprr_geometry/relative_pose.hpp"
#include "rprr_ros/conversions.hpp"

namespace rprr {

const std::string kA = "eyebug_a";
const std::string kB = "eyebug_b";

/// What a bag holds of one robot's camera at one instant.
struct RecordedView {
  sensor_msgs::CameraInfo info;
  sensor_msgs::Image rgb;
  sensor_msgs::Image depth;
  geometry_msgs::PoseStamped truth;
};
/// What both robots see, by robot.
using Moment = std::map<std::string, RecordedView>;

/// Lets the project's tool write a bag of both robots in the synthetic room.
inline void write_synthetic_bag(const std::string& path, int frames, int width, int height) {
  const std::string command = "rosrun rprr_sensor synthetic_to_bag " + path + " --frames " +
                              std::to_string(frames) + " --width " + std::to_string(width) +
                              " --height " + std::to_string(height) + " 2>/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// The instants of a bag in their order.
inline std::vector<Moment> read_moments(const std::string& path) {
  std::map<ros::Time, Moment> moments;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    for (const std::string& robot : {kA, kB}) {
      RecordedView& view = moments[message.getTime()][robot];
      const std::string topic = message.getTopic();
      if (topic == "/" + robot + "/camera/rgb/image_rect_color") {
        view.rgb = *message.instantiate<sensor_msgs::Image>();
      } else if (topic == "/" + robot + "/camera/rgb/camera_info") {
        view.info = *message.instantiate<sensor_msgs::CameraInfo>();
      } else if (topic == "/" + robot + "/camera/depth_registered/image_rect") {
        view.depth = *message.instantiate<sensor_msgs::Image>();
      } else if (topic == "/" + robot + "/ground_truth/pose") {
        view.truth = *message.instantiate<geometry_msgs::PoseStamped>();
      }
    }
  }
  std::vector<Moment> in_order;
  for (auto& [stamp, moment] : moments) in_order.push_back(std::move(moment));
  return in_order;
}

inline Pose true_pose(const RecordedView& view) {
  const auto& p = view.truth.pose.position;
  const auto& q = view.truth.pose.orientation;
  return make_pose({p.x, p.y, p.z}, {q.x, q.y, q.z, q.w});
}
inline Pose true_motion(const Moment& moment) {
  return relative_pose_of(true_pose(moment.at(kA)), true_pose(moment.at(kB)));
}

/// Plays what a bag holds of one camera, at stamps of the test's choice.
class CameraPlayer {
 public:
  CameraPlayer(ros::NodeHandle& nh, const std::string& robot)
      : info_(nh.advertise<sensor_msgs::CameraInfo>("/" + robot + "/camera/rgb/camera_info", 5)),
        rgb_(nh.advertise<sensor_msgs::Image>("/" + robot + "/camera/rgb/image_rect_color", 5)),
        depth_(nh.advertise<sensor_msgs::Image>("/" + robot + "/camera/depth_registered/image_rect",
                                                5)) {}

  /// Connections to listeners of all three topics.
  int listeners() const {
    return static_cast<int>(std::min(
        {info_.getNumSubscribers(), rgb_.getNumSubscribers(), depth_.getNumSubscribers()}));
  }
  void play(RecordedView view, const ros::Time& stamp) {
    view.info.header.stamp = view.rgb.header.stamp = view.depth.header.stamp = stamp;
    info_.publish(view.info);
    ros::WallDuration(0.05).sleep();  // info comes over another connection
    rgb_.publish(view.rgb);
    depth_.publish(view.depth);
  }

 private:
  ros::Publisher info_, rgb_, depth_;
};

}  // namespace rprr
