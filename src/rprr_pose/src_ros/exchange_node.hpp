// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>
#include <rprr_msgs/BlockPreview.h>
#include <rprr_msgs/PoseUpdate.h>
#include <rprr_msgs/RadioState.h>
#include <rprr_msgs/RelativePose.h>
#include <rprr_msgs/SamplePoints.h>
#include <rprr_msgs/SetReference.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clock_comparison.hpp"
#include "motion_report.hpp"
#include "rprr_pose/exchange_stage.hpp"
#include "rprr_pose/pose_options.hpp"
#include "rprr_radio_ros/radio_links.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/input_report.hpp"
#include "rprr_ros/rgbd_subscriber.hpp"
#include "rprr_ros/sender_watch.hpp"
#include "rprr_ros/worker.hpp"

namespace rprr {

/// Ties the pose stage of a robot to topics. The stage belongs to the worker thread: callbacks only
/// hand over what came.
class ExchangeNode {
 public:
  /// Told of every decision, on the worker thread.
  using Observer = std::function<void(const FrameDecision&, Health&)>;

  ExchangeNode(ros::NodeHandle nh, ros::NodeHandle private_nh, const ExchangeNodeOptions& options,
               const InputOptions& input, std::unique_ptr<ExchangeStage> stage, Observer observer);

 private:
  void advertise();
  void subscribe(const std::string& peer);
  template <typename Message>
  void listen(const std::string& peer, const std::string& topic);
  template <typename Message>
  void on_message(const std::string& peer, const ros::MessageEvent<Message const>& event);
  void on_radio(const rprr_msgs::RadioStateConstPtr& message);
  bool on_set_reference(rprr_msgs::SetReference::Request& request,
                        rprr_msgs::SetReference::Response& response);

  // The worker's thread.
  void set_reference(const std::string& peer, bool refer);
  void take(const std::string& peer, const PoseMessage& message, double age);
  void on_tick();
  void drive(const std::function<void(RoleOutput&)>& action);
  void publish(const FrameDecision& decision);
  void publish(const PoseMessage& message);
  void show(const std::string& peer, const PoseVerdict& verdict);

  ros::NodeHandle nh_;
  const ExchangeNodeOptions options_;
  Health health_;
  InputReport inputs_;
  Observer observer_;
  std::unique_ptr<ExchangeStage> stage_;  // worker thread
  ClockComparison clocks_;                // worker thread
  MotionReport motion_;                   // worker thread
  std::optional<SteadyTime> radio_told_;  // worker thread; when the radio's state came, if it did
  SenderWatch senders_;
  std::string own_frame_;              // of the newest frame; the worker's
  std::shared_ptr<RadioLinks> links_;  // null: links are not recovered
  ros::Publisher samples_, update_, preview_, pose_, decisions_;
  std::unique_ptr<Worker> worker_;  // before what posts to it, so that it goes after
  std::map<std::string, std::string> peer_topics_;  // one of each peer; not changed once it listens
  std::vector<ros::Subscriber> subscribers_;
  ros::ServiceServer service_;
  ros::WallTimer timer_;
  std::unique_ptr<RgbdSubscriber> input_;
};

}  // namespace rprr
