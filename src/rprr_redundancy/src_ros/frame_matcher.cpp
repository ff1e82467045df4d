// SPDX-License-Identifier: BSD-3-Clause
#include "frame_matcher.hpp"

#include <algorithm>
#include <utility>

#include "rprr_ros/conversions.hpp"

namespace rprr {
namespace {

constexpr std::size_t kWaitingEvents = 16;
constexpr std::size_t kMatchedKept = 10;

}  // namespace

FrameMatcher::FrameMatcher(std::size_t frames_held, double patience_seconds,
                           const std::string& robot, Health& health, Matched matched,
                           std::function<void()> restarted)
    : frames_(frames_held),
      patience_(std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(patience_seconds))),
      robot_(robot),
      health_(health),
      matched_(std::move(matched)),
      restarted_(std::move(restarted)) {
}

void FrameMatcher::add_frame(const RgbdFramePtr& frame) {
  if (!frames_.add(frame)) {
    matched_frames_.clear();
    restarted_();
  }
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    if (to_stamp(waiting->event->header.stamp) == frame->stamp) {
      match(waiting->event, frame);
      waiting = waiting_.erase(waiting);
    } else {
      ++waiting;
    }
  }
}

void FrameMatcher::add_event(const rprr_msgs::ExchangeEventConstPtr& event) {
  if (const RgbdFramePtr frame = find(to_stamp(event->header.stamp))) return match(event, frame);
  if (waiting_.size() >= kWaitingEvents) give_up_oldest();
  waiting_.push_back({event, Clock::now() + patience_});
}

void FrameMatcher::match(const rprr_msgs::ExchangeEventConstPtr& event, const RgbdFramePtr& frame) {
  if (std::find(matched_frames_.begin(), matched_frames_.end(), frame) == matched_frames_.end()) {
    matched_frames_.push_back(frame);
    if (matched_frames_.size() > kMatchedKept) matched_frames_.pop_front();
  }
  matched_(event, frame);
}

RgbdFramePtr FrameMatcher::find(Stamp stamp) const {
  if (RgbdFramePtr frame = frames_.find(stamp)) return frame;
  for (const RgbdFramePtr& frame : matched_frames_) {
    if (frame->stamp == stamp) return frame;
  }
  return nullptr;
}

void FrameMatcher::tick() {
  while (!waiting_.empty() && waiting_.front().deadline <= Clock::now()) give_up_oldest();
}

void FrameMatcher::give_up_oldest() {
  health_.error("frame not held",
                "the exchange with '" + waiting_.front().event->peer +
                    "' speaks of a frame that is not held (any more): its stamp must be that of "
                    "an image on /" +
                    robot_ +
                    "/camera/rgb/image_rect_color; raise ~frames_held if exchanges are slow");
  waiting_.pop_front();
}

}  // namespace rprr
