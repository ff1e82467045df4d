// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>
#include <rprr_msgs/BlockPreview.h>
#include <rprr_msgs/PoseUpdate.h>
#include <rprr_msgs/RadioState.h>
#include <rprr_msgs/RelativePose.h>
#include <rprr_msgs/SamplePoints.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "motion_report.hpp"
#include "rprr_geometry_ros/health.hpp"
#include "rprr_geometry_ros/radio_links.hpp"
#include "rprr_geometry_ros/rgbd_subscriber.hpp"
#include "rprr_geometry_ros/sender_watch.hpp"
#include "rprr_geometry_ros/worker.hpp"
#include "rprr_pose/clock_offset.hpp"
#include "rprr_pose/exchange.hpp"

namespace rprr {

/// Ties exchange roles, one for each peer, to topics. The roles belong to the worker thread:
/// callbacks only hand over what came.
class ExchangeNode {
 public:
  using Observer = std::function<void(const FrameDecision&, Health&)>;

  /// roles by peer. listen_to_poses: whether the peers' relative_pose topics concern this robot.
  /// stale_overlap: of MotionReport. The observer is told of every decision, on the worker thread.
  ExchangeNode(ros::NodeHandle nh, ros::NodeHandle private_nh, const std::string& name,
               const std::string& robot, std::map<std::string, std::unique_ptr<ExchangeRole>> roles,
               bool listen_to_poses, double stale_overlap, Observer observer);

 private:
  struct Side {
    std::unique_ptr<ExchangeRole> role;
    double ms = 0.0;  // processor time of the exchange under way
    // To compare clocks, seconds by this robot's:
    double question_age = 0.0;    // of the peer's frame when its last message came
    double question_delay = 0.0;  // from this robot's frame until its last message went
    ClockOffset clock;
  };

  void subscribe(const std::string& peer, bool listen_to_poses);
  void on_frame(const RgbdFramePtr& frame);
  template <typename Message>
  void on_message(const std::string& peer, const ros::MessageEvent<Message const>& event);
  void on_radio(const rprr_msgs::RadioStateConstPtr& message);
  void on_tick();
  void set_radio(const RadioState& radio);
  void time_message(const std::string& peer, const PoseMessage& message, double age);
  void compare_clocks(const std::string& peer, Side& side);
  void drive(const std::string& peer,
             const std::function<void(ExchangeRole&, RoleOutput&)>& action);
  void publish(const std::string& peer, const RoleOutput& output, double ms);
  void report_motion(const FrameDecision& decision);
  void show(const std::string& peer, const PoseVerdict& verdict);
  void publish(Side& side, const PoseMessage& message);

  ros::NodeHandle nh_;
  const std::string robot_;
  Health health_;
  Observer observer_;
  std::map<std::string, Side> sides_;  // worker thread only, as the next
  MotionReport motion_;                // likewise
  Stamp radio_told_ = 0;               // when the radio's state came; 0: none is known
  SenderWatch senders_;
  std::shared_ptr<RadioLinks> links_ = RadioLinks::of_this_process();
  ros::Publisher samples_, update_, preview_, pose_, event_;
  std::unique_ptr<Worker> worker_;  // before what posts to it, so that it goes after
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
  std::unique_ptr<RgbdSubscriber> input_;
};

}  // namespace rprr
