// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

namespace rprr {

/// Which entries of a recording play the two cameras of a pair: entry k is a, entry k + step is b.
struct PairScheduleOptions {
  std::size_t step = 1;   // entries from a to b
  std::size_t start = 0;  // first entry that is a
  std::size_t count = 0;  // pairs in a round; 0: as many as there are
  bool loop = false;      // begin again after the last pair
};

class PairSchedule {
 public:
  PairSchedule(std::size_t entries, const PairScheduleOptions& options)
      : start_(options.start), step_(options.step), loop_(options.loop), next_(options.start) {
    const bool fits = step_ < entries && start_ < entries - step_;
    const std::size_t most = fits ? entries - step_ - start_ : 0;
    pairs_ = options.count == 0 || options.count > most ? most : options.count;
  }

  /// Pairs in a round.
  std::size_t pairs() const { return pairs_; }

  /// Entries of a and b; nothing after the last pair.
  std::optional<std::pair<std::size_t, std::size_t>> next() {
    if (next_ == start_ + pairs_ && loop_) next_ = start_;
    if (next_ >= start_ + pairs_) return std::nullopt;
    const std::size_t a = next_++;
    return std::make_pair(a, a + step_);
  }

 private:
  std::size_t start_;
  std::size_t step_;
  bool loop_;
  std::size_t next_;
  std::size_t pairs_ = 0;
};

}  // namespace rprr
