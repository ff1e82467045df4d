// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/frame_buffer.hpp"

namespace rprr {

bool FrameBuffer::add(const RgbdFramePtr& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool goes_on = frames_.empty() || frame->stamp >= frames_.back()->stamp;
  if (!goes_on) frames_.clear();
  frames_.push_back(frame);
  if (frames_.size() > capacity_) frames_.pop_front();
  return goes_on;
}

RgbdFramePtr FrameBuffer::find(Stamp stamp) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
    if ((*frame)->stamp == stamp) return *frame;
  }
  return nullptr;
}

}  // namespace rprr
