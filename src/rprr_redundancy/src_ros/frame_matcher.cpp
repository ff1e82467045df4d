// SPDX-License-Identifier: BSD-3-Clause
#include "frame_matcher.hpp"

#include <utility>

#include "rprr_geometry_ros/conversions.hpp"

namespace rprr {
namespace {

constexpr std::size_t kWaitingEvents = 16;

}  // namespace

FrameMatcher::FrameMatcher(std::size_t frames_held, double patience_seconds, Matched matched,
                           Missed missed)
    : frames_(frames_held),
      patience_(std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(patience_seconds))),
      matched_(std::move(matched)),
      missed_(std::move(missed)) {
}

void FrameMatcher::add_frame(const RgbdFramePtr& frame) {
  frames_.add(frame);
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    if (to_stamp(waiting->event->header.stamp) == frame->stamp) {
      matched_(waiting->event, frame);
      waiting = waiting_.erase(waiting);
    } else {
      ++waiting;
    }
  }
}

void FrameMatcher::add_event(const rprr_msgs::ExchangeEventConstPtr& event) {
  if (const RgbdFramePtr frame = frames_.find(to_stamp(event->header.stamp))) {
    return matched_(event, frame);
  }
  if (waiting_.size() >= kWaitingEvents) {
    missed_(waiting_.front().event);
    waiting_.pop_front();
  }
  waiting_.push_back({event, Clock::now() + patience_});
}

void FrameMatcher::tick() {
  while (!waiting_.empty() && waiting_.front().deadline <= Clock::now()) {
    missed_(waiting_.front().event);
    waiting_.pop_front();
  }
}

}  // namespace rprr
