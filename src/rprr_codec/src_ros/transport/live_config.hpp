// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/ros.h>

#include <memory>
#include <mutex>
#include <string>

namespace rprr {

/// Settings that dynamic_reconfigure may change at any time from another thread.
template <typename Config>
class LiveConfig {
 public:
  /// Reads the parameters of the namespace and offers them for change. Where the namespace is
  /// taken (two subscribers of one topic in one node), they are read once.
  void start(const ros::NodeHandle& nh) {
    Config start = Config::__getDefault__();
    start.__fromServer__(nh);
    start.__clamp__();
    config_ = start;
    if (ros::service::exists(nh.resolveName("set_parameters"), false)) return;
    server_ = std::make_unique<dynamic_reconfigure::Server<Config>>(nh);
    server_->setCallback([this](Config& config, std::uint32_t) {
      const std::lock_guard<std::mutex> lock(mutex_);
      config_ = config;
    });
  }

  Config get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return config_;
  }

 private:
  mutable std::mutex mutex_;
  Config config_ = Config::__getDefault__();
  std::unique_ptr<dynamic_reconfigure::Server<Config>> server_;
};

}  // namespace rprr
