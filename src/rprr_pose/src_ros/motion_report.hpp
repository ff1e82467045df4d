// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <string>

#include "rprr_pose/camera_motion.hpp"
#include "rprr_pose/exchange.hpp"
#include "rprr_ros/health.hpp"

namespace rprr {

/// Says how far the robot moved while an exchange was under way: on its motion topic and on
/// /diagnostics. One thread at a time.
class MotionReport {
 public:
  /// Below stale_overlap, the share of the exchange's view that is still seen, the pose counts as
  /// one of the past and a warning says so.
  MotionReport(ros::NodeHandle& nh, const std::string& robot, double stale_overlap, Health& health);

  /// The robot's newest frame.
  void see(const RgbdFramePtr& frame) { newest_ = frame; }
  /// Compares the newest frame with that of an exchange that has just ended with a pose. Nothing is
  /// said while there is no newer one, and twice a second is enough unless somebody listens.
  void report(const RgbdFramePtr& frame, const std::string& peer, std::uint32_t exchange);

 private:
  void publish(const CameraMotion& b_from_a, const RgbdFrame& frame, const std::string& peer,
               std::uint32_t exchange);
  void judge(const CameraMotion& b_from_a, double seconds, const std::string& peer);

  const double stale_overlap_;
  Health& health_;
  ros::Publisher publisher_;
  RgbdFramePtr newest_;
  ros::SteadyTime next_;
  // Peers that share the frames share the answer.
  RgbdFramePtr compared_, compared_to_;
  CameraMotion motion_;
};

}  // namespace rprr
