// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <mutex>
#include <set>
#include <string>

#include "rprr_ros/health.hpp"
#include "rprr_ros/input_watch.hpp"

namespace rprr {

/// Says on a node's Health what the node needs and does not hear, a few seconds after it began or
/// fell silent, by the wall clock. That includes /clock where simulated time is used. Any thread
/// may call it.
///
/// How long it waits: the parameter /rprr/input_patience [s], which launch files set that start
/// their own source of images once everything is up; else InputWatch::kPatience.
class InputReport {
 public:
  /// Looks once a second, on the node handle's callback queue. health must outlive this object.
  InputReport(const ros::NodeHandle& nh, Health& health);

  /// topic: a full name that this process subscribes to; what: "colour images"; remedy: what the
  /// user can do, "start the camera".
  void expect(const std::string& topic, InputKind kind, const std::string& what,
              const std::string& remedy);
  void heard(const std::string& topic);

 private:
  void look();
  std::string clock_problem();

  Health& health_;
  const Duration patience_;
  std::mutex mutex_;
  InputWatch watch_;
  std::set<std::string> topics_;
  std::set<std::string> reported_;
  SteadyTime clock_since_;  // that simulated time has been awaited
  ros::WallTimer timer_;
};

}  // namespace rprr
