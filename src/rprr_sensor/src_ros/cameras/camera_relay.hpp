// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>

#include "rprr_ros/health.hpp"
#include "rprr_ros/input_report.hpp"

namespace rprr {

/// Gives the topics of somebody else's camera driver the names that RPRR wants. In the driver's
/// nodelet manager messages pass as shared pointers, without a copy. Parameters:
/// config/camera_relay.yaml.
///
/// Publishes /<robot>/camera/rgb/image_rect_color, .../rgb/camera_info and
/// .../depth_registered/image_rect exactly as they come; a topic that is silent is reported.
class CameraRelay : public nodelet::Nodelet {
 private:
  /// One topic, passed on.
  struct Line {
    std::string topic;  // what is passed on
    ros::Subscriber from;
    ros::Publisher to;
    std::atomic<std::uint64_t> passed{0};
  };

  void onInit() override;
  template <typename Message>
  void connect(Line& line, const std::string& from, const std::string& to);
  void show(const ros::WallTimerEvent& event);

  std::unique_ptr<Health> health_;
  std::unique_ptr<InputReport> inputs_;
  std::array<Line, 3> lines_;
  ros::WallTimer timer_;
};

}  // namespace rprr
