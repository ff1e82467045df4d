// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "rprr_radio_ros/host_watch.hpp"
#include "rprr_radio_ros/peer_sockets.hpp"
#include "rprr_ros/health.hpp"

namespace rprr {

/// Makes subscriptions to radio topics anew after a host was out of reach (HostWatch), so that what
/// is published is heard again within a second or so of the radio's return. Only the topics that
/// nodelets of RPRR name are renewed: whatever else the process subscribes to stays as it is. A
/// thread of its own, which owns everything but what `state_mutex_` guards.
///
/// Subscriptions are renewed through ROS's slave API, as the master would after a publisher came
/// (publisherUpdate, http://wiki.ros.org/ROS/Slave_API): a process asks itself, and the host that
/// publishes; the master is not asked.
class RadioLinks {
 public:
  /// The one of this process, for as long as somebody holds it. From now on it also looks after
  /// these topics (full names, as ros::Subscriber::getTopic has them). Before ros::start() it does
  /// nothing.
  static std::shared_ptr<RadioLinks> look_after(const std::vector<std::string>& topics);

  ~RadioLinks();
  RadioLinks(const RadioLinks&) = delete;
  RadioLinks& operator=(const RadioLinks&) = delete;

  struct State {
    std::size_t renewed = 0;                       // subscriptions so far
    std::map<std::string, double> unanswered_for;  // hosts out of reach, and for how long [s]
  };
  State state() const;

 private:
  struct Host {
    HostWatch watch;
    Probe probe;
  };

  RadioLinks();
  void run();
  void look();

  std::map<std::string, Host> hosts_;
  mutable std::mutex state_mutex_;  // guards state_, topics_ and stop_
  State state_;
  std::set<std::string> topics_;
  bool stop_ = false;
  std::condition_variable wake_;
  std::thread thread_;  // last: starts when everything else is ready
};

/// Shows on a nodelet's /diagnostics what the links are like.
void show(const RadioLinks::State& state, Health& health);

/// Drops this process's subscriptions of these topics to nodes on that host (numeric address) and
/// makes them anew. Returns how many; connections within the process stay as they are.
std::size_t renew_subscriptions(const std::string& host, const std::set<std::string>& topics);

}  // namespace rprr
