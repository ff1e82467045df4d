// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <memory>
#include <mutex>
#include <string>

#include "rprr_ros/live_options.hpp"
#include "rprr_ros/parameters.hpp"

namespace rprr {

/// Settings of a transport, a struct with a table of options, that dynamic_reconfigure may change
/// at any time from another thread.
template <typename Settings>
class LiveSettings {
 public:
  /// Reads the parameters of the namespace and offers them for change. Wrong parameters are an
  /// error message, and the defaults are used: a transport cannot keep its node from starting.
  /// Where the namespace is taken (two subscribers of one topic in one node), they are read once.
  void start(const ros::NodeHandle& nh) {
    const auto warn = [name = nh.getNamespace()](const std::string& reason) {
      ROS_ERROR_STREAM(name << ": " << reason);
    };
    const std::string wrong = read_parameters(nh, options_of(next_));
    if (wrong.empty()) {
      take();
    } else {
      warn("wrong parameters: " + wrong + ". The defaults of all are used until this is mended");
      next_ = Settings();
    }
    if (ros::service::exists(nh.resolveName("set_parameters"), false)) return;
    live_ = std::make_unique<LiveOptions>(
        nh, options_of(next_), [warn](const std::string& reason) { warn("refused: " + reason); },
        [this] {
          take();
          return std::string();
        });
  }

  Settings get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return settings_;
  }

 private:
  void take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    settings_ = next_;
  }

  Settings next_;  // the table's; written by start() and by the thread of requests only
  mutable std::mutex mutex_;
  Settings settings_;
  std::unique_ptr<LiveOptions> live_;
};

}  // namespace rprr
