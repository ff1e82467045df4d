// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dhcm/scan.hpp"
#include "dhcm/tables.hpp"

namespace rprr::dhcm {

/// A pixel that stands in the payload, and how many pixels of its context behind it are as guessed.
struct Event {
  std::uint8_t context;
  std::uint8_t symbol;  // of the residual, or kHoleSymbol
  std::uint16_t extra;
  std::uint32_t run;
};

/// Contexts whose every pixel is an event: where about half of the guesses fail, counting the right
/// ones costs more than it saves.
using DirectContexts = std::array<bool, kContexts>;

/// First pass of an encoder: pixels become events.
class EventCoder {
 public:
  void begin(int width, const DirectContexts& direct);
  /// A row of ranks (or readings), 0 = no reading, and its segments. With room for kLanes beyond
  /// the width.
  void row(const std::uint16_t* ranks, const std::vector<Segment>& segments);
  /// After the last row: closes the runs and counts the symbols.
  void finish(Histograms& histograms);
  /// Which contexts would have taken fewer bits with every pixel an event, judged by the symbols
  /// that finish counted while none was.
  DirectContexts better_direct(const Histograms& histograms) const;
  const Event* events() const { return events_.data(); }
  std::size_t event_count() const { return event_count_; }

 private:
  void below_known(const std::uint16_t* ranks, const Segment& segment);
  void first_row(const std::uint16_t* ranks, const Segment& segment);
  void count(int begin, int end);
  void collect(int begin, int end);
  void collect_part(int begin, int end);
  void add(std::size_t context, std::uint32_t ordinal, bool hole, std::int16_t residual);

  DirectContexts direct_{};
  Surface surface_;
  std::vector<Event> events_;  // as long as any frame needed so far
  std::size_t event_count_ = 0;
  std::array<std::uint8_t, kContexts> forced_{};   // every pixel is an event: direct, or the first
  std::array<std::uint32_t, kContexts> pixels_{};  // of each context so far
  std::array<std::uint32_t, kContexts> next_{};    // ordinal of the pixel behind the last event
  std::array<std::size_t, kContexts> last_event_{};
  std::array<std::array<std::uint32_t, kContexts>, 4> part_pixels_{};  // of a segment
  // The row that is being coded, by column.
  Surface current_;
  std::vector<std::uint8_t> north_;
  std::vector<std::int16_t> step_;
  std::vector<std::int16_t> place_;  // in the context map
  std::vector<std::uint8_t> miss_;
  std::vector<std::int16_t> residual_;
  std::vector<std::uint8_t> context_;
  std::vector<std::uint32_t> ordinal_;  // of the pixel in its context, in a part of the segment
};

}  // namespace rprr::dhcm
