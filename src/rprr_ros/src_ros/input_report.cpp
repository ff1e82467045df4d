// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/input_report.hpp"

#include <ros/param.h>
#include <ros/topic_manager.h>

#include <algorithm>
#include <map>

#include "rprr_ros/steady_now.hpp"

namespace rprr {
namespace {

constexpr double kLongestPatience = 600.0;  // [s]

Duration configured_patience() {
  double seconds = to_seconds(InputWatch::kPatience);
  ros::param::get("/rprr/input_patience", seconds);
  return from_seconds(std::clamp(seconds, 0.0, kLongestPatience));
}

}  // namespace

InputReport::InputReport(const ros::NodeHandle& nh, Health& health)
    : health_(health),
      patience_(configured_patience()),
      watch_(patience_),
      clock_since_(steady_now()),
      timer_(nh.createWallTimer(ros::WallDuration(1.0),
                                [this](const ros::WallTimerEvent&) { look(); })) {
}

void InputReport::expect(const std::string& topic, InputKind kind, const std::string& what,
                         const std::string& remedy) {
  const std::lock_guard<std::mutex> lock(mutex_);
  watch_.expect(topic, kind, what, remedy, steady_now());
  topics_.insert(topic);
}

void InputReport::heard(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  watch_.heard(topic, steady_now());
}

void InputReport::look() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const SteadyTime now = steady_now();
  for (const std::string& topic : topics_) {
    watch_.connected(topic, ros::TopicManager::instance()->getNumPublishers(topic), now);
  }
  std::map<std::string, std::string> problems;
  for (const InputWatch::Problem& problem : watch_.problems(now)) {
    problems["not heard: " + problem.topic] = problem.text;
  }
  const std::string clock = clock_problem();
  if (!clock.empty()) problems["not heard: /clock"] = clock;
  for (const std::string& key : reported_) {
    if (problems.count(key) == 0) health_.clear(key);
  }
  reported_.clear();
  for (const auto& [key, text] : problems) {
    health_.warn(key, text);
    reported_.insert(key);
  }
}

std::string InputReport::clock_problem() {
  if (!ros::Time::isSimTime() || ros::Time::isValid()) clock_since_ = steady_now();
  if (steady_now() - clock_since_ < patience_) return {};
  return "/use_sim_time is true but nothing comes on /clock, so time stands still: play the bag "
         "with --clock, or set the parameter to false and start the nodes again";
}

}  // namespace rprr
