// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "rprr_geometry/steady_time.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// What a channel does to messages. Shares are probabilities of each message, 0 to 1.
struct Faults {
  double lose = 0.0;
  double duplicate = 0.0;  // the copy comes as late as a reordered message
  double reorder = 0.0;    // comes `late` later than it would
  double corrupt = 0.0;    // a few bits are flipped, in this copy
  Duration delay = 0;      // of every message
  Duration late = from_seconds(0.15);
  bool down = false;  // nothing passes, and nothing is kept
};

/// A message, and which of its bytes may be flipped.
struct ChannelMessage {
  Bytes bytes;
  std::size_t flip_from = 0;
  std::size_t flip_count = 0;  // 0: none
};

/// A lossy channel for one topic: the same seed and the same calls make the same faults. A state
/// machine without a clock of its own: `now` is any steady time in nanoseconds. Memory is bounded:
/// beyond `capacity` messages under way, new ones are lost.
class FaultChannel {
 public:
  struct Counts {
    std::size_t came = 0;
    std::size_t lost = 0;  // also while down
    std::size_t duplicated = 0;
    std::size_t reordered = 0;
    std::size_t corrupted = 0;
  };

  explicit FaultChannel(std::uint32_t seed, std::size_t capacity = 1000)
      : random_(seed), capacity_(capacity) {}

  /// From now on; what is under way stays as it is, but for a channel that goes down.
  void set(const Faults& faults);
  void add(ChannelMessage message, SteadyTime now);
  /// Messages that come out until now, in their order.
  std::vector<Bytes> due(SteadyTime now);

  const Counts& counts() const { return counts_; }
  std::size_t under_way() const { return under_way_.size(); }

 private:
  static constexpr int kFlips = 4;  // bits of a corrupted message

  bool happens(double probability);
  void corrupt(ChannelMessage& message);

  std::mt19937 random_;
  std::size_t capacity_;
  Faults faults_;
  std::multimap<SteadyTime, Bytes> under_way_;  // by when they come out
  Counts counts_;
};

}  // namespace rprr
