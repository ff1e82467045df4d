// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "rprr_pose/clock_offset.hpp"
#include "rprr_pose/messages.hpp"
#include "rprr_ros/health.hpp"

namespace rprr {

/// Compares the clocks of robots by the messages of their exchanges, as NTP does, and says on
/// /diagnostics how far they are apart. One thread at a time.
class ClockComparison {
 public:
  ClockComparison(std::string robot, Health& health);

  /// A message of a peer came. age: from the stamp of the frame that it belongs to until it came,
  /// by this robot's clock [s].
  void received(const std::string& peer, const PoseMessage& message, double age);
  /// A message to a peer goes out now. age: from the stamp of its frame until now [s]. Fills in
  /// what a pose tells the peer of this robot's clock.
  void sending(const std::string& peer, PoseMessage& message, double age);

 private:
  struct Peer {
    double question_age = 0.0;    // of the peer's frame when its last message came [s]
    double question_delay = 0.0;  // from this robot's frame until its last message went [s]
    ClockOffset clock;
  };

  void report(const std::string& peer, ClockOffset& clock);

  const std::string robot_;
  Health& health_;
  std::map<std::string, Peer> peers_;
};

}  // namespace rprr
