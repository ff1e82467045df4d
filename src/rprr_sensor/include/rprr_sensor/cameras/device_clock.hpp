// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// Turns times of a device's own clock into ours. The shortest delay seen between both tells their
/// offset, so that late arrivals do not show in the stamps; a slow drift of the clocks is followed.
class DeviceClock {
 public:
  /// The time of an image, ours, that arrived at `arrival`; never later than that. A device's
  /// clock that jumps (a restart, a recording that begins again) is found out and followed.
  Stamp stamp(Duration device_time, Stamp arrival);

 private:
  bool set_ = false;
  Duration offset_ = 0;  // ours minus the device's
  Stamp last_arrival_ = 0;
};

/// A counter of 32 bits, of `ticks_per_second`, that starts again from 0: as nanoseconds that go
/// on. It may be read slightly out of order.
class TickCounter {
 public:
  explicit TickCounter(double ticks_per_second) : ticks_per_second_(ticks_per_second) {}
  Duration read(std::uint32_t ticks);

 private:
  double ticks_per_second_;
  bool set_ = false;
  std::uint32_t last_ = 0;
  std::int64_t total_ = 0;
};

}  // namespace rprr
