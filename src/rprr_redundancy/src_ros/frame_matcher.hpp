// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/ExchangeEvent.h>

#include <chrono>
#include <deque>
#include <functional>
#include <string>

#include "rprr_ros/frame_buffer.hpp"
#include "rprr_ros/health.hpp"

namespace rprr {

/// Brings an exchange's events together with the frames that they speak of. Both come over topics
/// of their own, so either may be first. Bounded; not for several threads at once.
class FrameMatcher {
 public:
  using Matched = std::function<void(const rprr_msgs::ExchangeEventConstPtr&, const RgbdFramePtr&)>;

  /// Health, which must live longer, is told of events whose frame does not come. restarted: time
  /// went back (a bag that starts again), so stamps mean other frames from now on.
  FrameMatcher(std::size_t frames_held, double patience_seconds, const std::string& robot,
               Health& health, Matched matched, std::function<void()> restarted);

  void add_frame(const RgbdFramePtr& frame);
  void add_event(const rprr_msgs::ExchangeEventConstPtr& event);
  /// Gives up events whose frame does not come.
  void tick();

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    rprr_msgs::ExchangeEventConstPtr event;
    Clock::time_point deadline;
  };

  void match(const rprr_msgs::ExchangeEventConstPtr& event, const RgbdFramePtr& frame);
  RgbdFramePtr find(Stamp stamp) const;
  void give_up_oldest();

  FrameBuffer frames_;
  std::deque<RgbdFramePtr> matched_frames_;  // kept longer: exchanges may refer to them again
  Clock::duration patience_;
  std::string robot_;
  Health& health_;
  Matched matched_;
  std::function<void()> restarted_;
  std::deque<Waiting> waiting_;
};

}  // namespace rprr
