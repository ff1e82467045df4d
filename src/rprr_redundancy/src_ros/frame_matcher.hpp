// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/ExchangeEvent.h>

#include <chrono>
#include <deque>
#include <functional>

#include "rprr_geometry_ros/frame_buffer.hpp"

namespace rprr {

/// Brings an exchange's events together with the frames that they speak of. Both come over topics
/// of their own, so either may be first. Bounded; not for several threads at once.
class FrameMatcher {
 public:
  using Matched = std::function<void(const rprr_msgs::ExchangeEventConstPtr&, const RgbdFramePtr&)>;
  using Missed = std::function<void(const rprr_msgs::ExchangeEventConstPtr&)>;

  FrameMatcher(std::size_t frames_held, double patience_seconds, Matched matched, Missed missed);

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

  FrameBuffer frames_;
  Clock::duration patience_;
  Matched matched_;
  Missed missed_;
  std::deque<Waiting> waiting_;
};

}  // namespace rprr
