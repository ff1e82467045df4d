// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <deque>

#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// A robot's last frames, to find the one that was taken when the peer's was.
class RecentFrames {
 public:
  RecentFrames(std::size_t capacity, Duration max_difference)
      : capacity_(capacity), max_difference_(max_difference) {}

  /// A stamp before the newest one (time went back) empties the buffer first.
  void add(const RgbdFramePtr& frame) {
    if (!frames_.empty() && frame->stamp < frames_.back()->stamp) frames_.clear();
    frames_.push_back(frame);
    if (frames_.size() > capacity_) frames_.pop_front();
  }
  RgbdFramePtr nearest(Stamp stamp) const { return nearest(stamp, max_difference_); }
  RgbdFramePtr nearest(Stamp stamp, Duration max_difference) const {
    RgbdFramePtr best;
    Stamp best_difference = max_difference;
    for (const RgbdFramePtr& frame : frames_) {
      const Stamp difference = std::abs(frame->stamp - stamp);
      if (difference > best_difference) continue;
      best_difference = difference;
      best = frame;
    }
    return best;
  }
  /// Null if there is none.
  RgbdFramePtr newest() const { return frames_.empty() ? nullptr : frames_.back(); }

 private:
  const std::size_t capacity_;
  const Duration max_difference_;
  std::deque<RgbdFramePtr> frames_;
};

}  // namespace rprr
