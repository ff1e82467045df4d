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

  /// restarted: time went back (a bag that starts again), so stamps mean other frames from now on.
  FrameMatcher(std::size_t frames_held, double patience_seconds, Matched matched, Missed missed,
               std::function<void()> restarted);

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

  FrameBuffer frames_;
  std::deque<RgbdFramePtr> matched_frames_;  // kept longer: exchanges may refer to them again
  Clock::duration patience_;
  Matched matched_;
  Missed missed_;
  std::function<void()> restarted_;
  std::deque<Waiting> waiting_;
};

}  // namespace rprr
