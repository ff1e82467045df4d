// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <image_transport/image_transport.h>
#include <image_transport/subscriber.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/input_options.hpp"

namespace rprr {

/// Subscribes /<robot>/camera/rgb/image_rect_color, .../rgb/camera_info and
/// .../depth_registered/image_rect, pairs colour and depth by stamp and checks them. What does not
/// fit is dropped with a message and a diagnostic that name the topic and the remedy; depth without
/// a single reading is reported and passed on. A frame keeps the messages alive where it shares
/// their pixels.
class RgbdSubscriber {
 public:
  using Callback = std::function<void(const RgbdFramePtr&)>;

  /// The callback runs on the node handle's callback queue. health must outlive this object.
  /// Parameters of image_transport itself are read from private_nh.
  RgbdSubscriber(ros::NodeHandle nh, ros::NodeHandle private_nh, const std::string& robot,
                 const InputOptions& options, Health& health, Callback callback);

 private:
  void on_info(const sensor_msgs::CameraInfoConstPtr& info);
  void on_rgb(const sensor_msgs::ImageConstPtr& image);
  void on_depth(const sensor_msgs::ImageConstPtr& image);
  void emit(const sensor_msgs::ImageConstPtr& rgb, const sensor_msgs::ImageConstPtr& depth);
  void watch(const ros::WallTimerEvent&);
  void watch_stamp(const ros::Time& stamp);

  Health& health_;
  Callback callback_;
  const InputOptions options_;
  std::mutex mutex_;
  std::deque<sensor_msgs::ImageConstPtr> waiting_rgb_;
  std::deque<sensor_msgs::ImageConstPtr> waiting_depth_;
  sensor_msgs::CameraInfoConstPtr info_;
  ros::Time last_stamp_;                                          // of the last pair
  ros::SteadyTime last_arrival_;                                  // of the last pair
  std::uint64_t rgb_seen_ = 0, depth_seen_ = 0, pairs_seen_ = 0;  // since the last look
  image_transport::ImageTransport transport_;
  image_transport::Subscriber rgb_subscriber_;
  image_transport::Subscriber depth_subscriber_;
  ros::Subscriber info_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace rprr
