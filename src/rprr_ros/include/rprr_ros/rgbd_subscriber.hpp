// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <image_transport/image_transport.h>
#include <image_transport/subscriber.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/input_options.hpp"
#include "rprr_ros/input_report.hpp"

namespace rprr {

class GuardedQueue;
class ImagePairing;

/// Subscribes /<robot>/camera/rgb/image_rect_color, .../rgb/camera_info and
/// .../depth_registered/image_rect, pairs colour and depth by stamp and checks them. What does not
/// fit is dropped with a message and a diagnostic that name the topic and the remedy; what is only
/// implausible is reported and passed on. Frames that come before the first camera_info wait for
/// it. A frame keeps the messages alive where it shares their pixels.
class RgbdSubscriber {
 public:
  using Callback = std::function<void(const RgbdFramePtr&)>;

  /// The callback runs on a thread of this object, on which transports may throw. health must
  /// outlive this object.
  /// Parameters of image_transport itself are read from private_nh.
  RgbdSubscriber(const ros::NodeHandle& nh, ros::NodeHandle private_nh, const std::string& robot,
                 const InputOptions& options, Health& health, Callback callback);
  ~RgbdSubscriber();

 private:
  /// What has been seen of one of the two image streams.
  struct Stream {
    image_transport::Subscriber subscriber;
    std::string topic;
    std::string heard_on;    // the topic of its transport
    ros::Time last;          // stamp of the last image
    unsigned same = 0;       // images with that stamp after the first
    std::uint64_t seen = 0;  // images since the last look
  };
  struct Pair {
    sensor_msgs::ImageConstPtr rgb, depth;
    ros::SteadyTime came;
  };

  bool subscribe(ros::NodeHandle& nh, ros::NodeHandle& private_nh);
  std::string installed_transports() const;
  void expect_inputs();
  bool is_new(Stream& stream, const sensor_msgs::Image& image);
  void on_info(const sensor_msgs::CameraInfoConstPtr& info);
  void on_pair(const sensor_msgs::ImageConstPtr& rgb, const sensor_msgs::ImageConstPtr& depth);
  void emit(const Pair& pair, const sensor_msgs::CameraInfo& info);
  void doubt(const Pair& pair, const sensor_msgs::CameraInfo& info, const DepthFrame& depth);
  void report(const std::string& key, const std::string& text);
  void watch(const ros::WallTimerEvent&);
  void watch_stamp(const ros::Time& stamp);

  const std::string robot_;
  const InputOptions options_;
  Health& health_;
  Callback callback_;
  InputReport inputs_;
  std::mutex mutex_;                     // of all below
  std::unique_ptr<GuardedQueue> queue_;  // of all three streams
  std::unique_ptr<image_transport::ImageTransport> transport_;
  Stream rgb_, depth_;
  std::string info_topic_;
  sensor_msgs::CameraInfoConstPtr info_;
  std::deque<Pair> waiting_;  // for the first camera_info
  ros::Time last_stamp_;      // of the last pair
  ros::SteadyTime last_arrival_;
  std::uint64_t pairs_seen_ = 0;  // since the last look
  std::unique_ptr<ImagePairing> pairing_;
  ros::Subscriber info_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace rprr
