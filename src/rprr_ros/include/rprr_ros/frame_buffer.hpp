// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>

#include "rprr_ros/rgbd_subscriber.hpp"

namespace rprr {

/// A robot's last frames, found by their stamps. Any thread may call it.
class FrameBuffer {
 public:
  explicit FrameBuffer(std::size_t capacity) : capacity_(capacity) {}

  /// The oldest frame leaves when the buffer is full. A stamp before the newest one (a bag that
  /// starts again) empties the buffer first: false then.
  bool add(const RgbdFramePtr& frame);
  /// The frame of exactly this stamp, or null.
  RgbdFramePtr find(Stamp stamp) const;

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::deque<RgbdFramePtr> frames_;
};

}  // namespace rprr
