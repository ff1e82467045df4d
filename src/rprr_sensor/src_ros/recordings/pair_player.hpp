// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <rprr_msgs/PairStatistics.h>
#include <std_srvs/Trigger.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "recordings/player_options.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/input_report.hpp"
#include "rprr_ros/worker.hpp"
#include "rprr_sensor/recordings/pair_schedule.hpp"
#include "rprr_sensor_ros/recording.hpp"

namespace rprr {

/// Plays the recording of one camera as two robots: entry k as a, entry k + step as b, both stamped
/// now. Parameters: config/pair_player.yaml.
///
/// Publishes each robot's camera topics and, where known, /<robot>/ground_truth/pose; ~done
/// (std_msgs/Bool, latched) at the end, false if something could not be played. Subscribes
/// /station/statistics with ~handshake. Service ~next (std_srvs/Trigger) plays a pair where neither
/// ~rate nor ~handshake sets the pace.
class PairPlayer : public nodelet::Nodelet {
 public:
  ~PairPlayer() override;

 private:
  struct Outputs {
    std::string robot;
    ros::Publisher colour;
    ros::Publisher camera_info;
    ros::Publisher depth;
    ros::Publisher pose;
  };

  void onInit() override;
  Outputs advertise(const std::string& robot);
  void on_statistics(const rprr_msgs::PairStatisticsConstPtr& statistics);
  bool on_next(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  // On the worker's thread:
  void play();
  void fail(const std::string& reason);
  bool play_pair(Recording& recording, std::size_t a, std::size_t b);
  void publish(const Outputs& outputs, const RecordedFrame& frame, const Camera& camera,
               const ros::Time& stamp);
  void await_subscribers();
  void await_turn();
  void await_answer(const ros::Time& stamp);
  ros::Time fresh_stamp();
  void finish(bool all_played);
  bool running() const;
  /// Sleeps until `ready` says so (looked at every few ms and when something arrives), the player
  /// stops or the wall time is over; negative: no limit. Returns what `ready` said last.
  bool wait_until(const std::function<bool()>& ready, double timeout);

  PlayerOptions settings_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<InputReport> inputs_;
  Outputs a_;
  Outputs b_;
  ros::Publisher done_;
  ros::Subscriber statistics_;
  ros::ServiceServer next_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  int requested_ = 0;               // pairs asked for on ~next and not played yet
  ros::Time answered_;              // stamp of b's last frame that the station reported on
  ros::Time last_stamp_;            // of the last pair played
  ros::Time due_;                   // when the last pair was to be played
  std::unique_ptr<Worker> worker_;  // last: stops before the rest goes
};

}  // namespace rprr
