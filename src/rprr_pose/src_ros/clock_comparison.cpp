// SPDX-License-Identifier: BSD-3-Clause
#include "clock_comparison.hpp"

#include <cmath>
#include <utility>

#include "rprr_ros/steady_now.hpp"

namespace rprr {
namespace {

constexpr double kClocksApart = 0.02;  // the pairing of frames suffers from here on [s]

}  // namespace

ClockComparison::ClockComparison(std::string robot, Health& health)
    : robot_(std::move(robot)), health_(health) {
}

void ClockComparison::received(const std::string& peer, const PoseMessage& message, double age) {
  Peer& side = peers_[peer];
  const auto* pose = std::get_if<RelativePoseMessage>(&message);
  if (pose == nullptr) {
    side.question_age = age;
  } else if (pose->dependent == robot_ && pose->dependent_age != 0.0) {
    side.clock.add(pose->dependent_age - side.question_delay,
                   age - static_cast<double>(pose->reply_delay), steady_now());
    report(peer, side.clock);
  }
}

void ClockComparison::sending(const std::string& peer, PoseMessage& message, double age) {
  Peer& side = peers_[peer];
  if (auto* pose = std::get_if<RelativePoseMessage>(&message)) {
    pose->dependent_age = side.question_age;
    pose->reply_delay = static_cast<float>(age);
  } else if (!std::holds_alternative<UpdateMessage>(message)) {
    side.question_delay = age;
  }
}

void ClockComparison::report(const std::string& peer, ClockOffset& clock) {
  const auto estimate = clock.estimate(steady_now());
  if (!estimate) return;
  const auto ms = std::lround(estimate->offset * 1e3);
  health_.show("clock of " + peer + " is ahead, ms", std::to_string(ms));
  health_.show("clock of " + peer + " is ahead, ms uncertain",
               std::to_string(static_cast<int>(std::lround(estimate->uncertainty * 1e3))));
  if (std::abs(estimate->offset) - estimate->uncertainty < kClocksApart) return;
  health_.warn("clocks differ", "the clock of '" + peer + "' is " + std::to_string(std::abs(ms)) +
                                    (ms > 0 ? " ms ahead of" : " ms behind") +
                                    " this robot's, so frames of different instants are paired, or "
                                    "none: keep both together with chrony");
}

}  // namespace rprr
