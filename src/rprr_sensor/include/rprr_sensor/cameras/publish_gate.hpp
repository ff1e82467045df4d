// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// Which of a camera's frames are published: every so many, at most so often, none while paused,
/// but one for each trigger then. With a rate, the first frame after every whole multiple of its
/// period goes out, so that robots whose clocks agree choose frames of the same moments.
class PublishGate {
 public:
  /// Every `every_nth` frame (at least 1), at most `max_rate` a second (0: no limit).
  void limit(int every_nth, double max_rate);
  void pause(bool paused);
  bool paused() const { return paused_; }
  /// Lets the next frame through although paused. False, and nothing, if not paused.
  bool trigger();

  /// Whether the frame of that stamp goes out. Stamps that jump back begin anew.
  bool pass(Stamp stamp);

 private:
  bool on_time(Stamp stamp);

  int every_nth_ = 1;
  Duration period_ = 0;  // between two frames, ns; 0: no limit
  bool paused_ = false;
  int triggered_ = 0;
  int skipped_ = 0;
  Stamp last_seen_ = 0;
  Stamp last_passed_ = 0;
  std::int64_t last_slot_ = -1;  // of the periods since the epoch, the last one used up
};

}  // namespace rprr
