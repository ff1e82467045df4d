// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// Remembers the last few stamps, so that a frame that several exchanges share goes out once.
class RecentStamps {
 public:
  explicit RecentStamps(std::size_t capacity = 64)
      : capacity_(std::max<std::size_t>(capacity, 1)) {}

  bool contains(Stamp stamp) const {
    return std::find(stamps_.begin(), stamps_.end(), stamp) != stamps_.end();
  }
  /// False if the stamp is known already.
  bool insert(Stamp stamp) {
    if (contains(stamp)) return false;
    if (stamps_.size() == capacity_) stamps_.pop_front();
    stamps_.push_back(stamp);
    return true;
  }

 private:
  std::size_t capacity_;
  std::deque<Stamp> stamps_;
};

}  // namespace rprr
