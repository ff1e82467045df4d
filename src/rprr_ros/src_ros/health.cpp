// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/health.hpp"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/console.h>

#include <algorithm>

namespace rprr {
namespace {

constexpr double kLogPeriod = 5.0;          // [s] doubled each time that the same is logged ...
constexpr double kLongestLogPeriod = 60.0;  // [s] ... up to this
constexpr double kShownFor = 10.0;          // [s]

}  // namespace

Health::Health(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
               const std::string& name, const std::string& hardware)
    : name_(name),
      updater_(std::make_unique<diagnostic_updater::Updater>(nh, private_nh,
                                                             private_nh.getNamespace())) {
  updater_->setHardwareID(hardware);
  updater_->add(name, this, &Health::fill);
  timer_ = nh.createWallTimer(ros::WallDuration(1.0),
                              [this](const ros::WallTimerEvent&) { updater_->force_update(); });
}

Health::~Health() = default;

void Health::warn(const std::string& key, const std::string& text) {
  report(key, text, false);
}
void Health::error(const std::string& key, const std::string& text) {
  report(key, text, true);
}

void Health::refuse_parameters(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Problem& problem = problems_["parameters"];
  problem.is_error = true;
  problem.lasts = true;
  problem.text = "wrong parameters: " + text;
  problem.times = 1;
  ROS_FATAL_STREAM_NAMED(name_, name_ << ": " << problem.text
                                      << ". It does nothing until they are mended and it is "
                                         "started again.");
}

void Health::report(const std::string& key, const std::string& text, bool is_error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Problem& problem = problems_[key];
  const ros::WallTime now = ros::WallTime::now();
  if ((now - problem.last).toSec() > kShownFor) problem.log_period = 0.0;
  problem.is_error = is_error;
  problem.text = text;
  problem.last = now;
  ++problem.times;
  if ((now - problem.logged).toSec() < std::max(kLogPeriod, problem.log_period)) return;
  problem.logged = now;
  problem.log_period = std::clamp(2.0 * problem.log_period, kLogPeriod, kLongestLogPeriod);
  if (is_error) {
    ROS_ERROR_STREAM_NAMED(name_, name_ << ": " << text);
  } else {
    ROS_WARN_STREAM_NAMED(name_, name_ << ": " << text);
  }
}

void Health::clear(const std::string& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = problems_.find(key);
  if (found != problems_.end()) found->second.last = ros::WallTime();
}

void Health::count(const std::string& counter, std::uint64_t by) {
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_[counter] += by;
}

void Health::show(const std::string& name, const std::string& value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  values_[name] = value;
}

void Health::fill(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::WallTime now = ros::WallTime::now();
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  for (const auto& [key, problem] : problems_) {
    status.add(key + " (times)", problem.times);
    if (!problem.lasts && (now - problem.last).toSec() > kShownFor) continue;
    status.mergeSummary(problem.is_error ? diagnostic_msgs::DiagnosticStatus::ERROR
                                         : diagnostic_msgs::DiagnosticStatus::WARN,
                        problem.text);
  }
  for (const auto& [counter, value] : counters_) status.add(counter, value);
  for (const auto& [value_name, value] : values_) status.add(value_name, value);
}

}  // namespace rprr
