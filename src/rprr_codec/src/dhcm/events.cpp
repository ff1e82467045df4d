// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/events.hpp"

#include <algorithm>
#include <cstring>

namespace rprr::dhcm {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};

// Ranks to the surface that they leave: north's where there is no reading.
void take_ranks(const std::uint16_t* ranks, const std::int16_t* north, int begin, int end,
                std::int16_t* fill, std::int16_t* hole) {
  for (int u = begin; u < end; u += kLanes) {
    Lanes rank;
    std::memcpy(&rank, ranks + u, sizeof(rank));
    const Lanes none = rank == 0;
    store(none & all(1), hole + u);
    store(select(none, load(north + u), rank), fill + u);
  }
}

// Eight bytes of 0 or 1 as bits, the first one lowest.
std::uint64_t bits_of_bytes(const std::uint8_t* bytes) {
  return (load64(bytes) * 0x0102040810204080u) >> 56;
}

constexpr int kParts = 4;
// In how many parts a segment is coded; a narrow one is not worth more than one.
int parts_of(int begin, int end) {
  return end - begin >= 128 ? kParts : 1;
}

}  // namespace

void EventCoder::begin(int width, const DirectContexts& direct) {
  direct_ = direct;
  surface_.reset(width);
  current_.reset(width);
  event_count_ = 0;
  forced_.fill(1);
  pixels_.fill(0);
  next_.fill(0);
  last_event_.fill(kNone);
  const auto columns = static_cast<std::size_t>(width + kLanes);
  north_.resize(columns);
  step_.resize(columns);
  place_.resize(columns);
  miss_.resize(columns);
  residual_.resize(columns);
  context_.resize(columns);
  ordinal_.resize(columns);
}

void EventCoder::row(const std::uint16_t* ranks, const std::vector<Segment>& segments) {
  // Not more events than pixels.
  const std::size_t most = event_count_ + context_.size();
  if (events_.size() < most) events_.resize(2 * most);
  for (const Segment& segment : segments) {
    if (segment.north) {
      below_known(ranks, segment);
    } else {
      first_row(ranks, segment);
    }
  }
}

void EventCoder::below_known(const std::uint16_t* ranks, const Segment& segment) {
  const int begin = segment.begin;
  const int end = segment.end;
  surface_.prepare(segment);
  classify_north(surface_.fill(), surface_.hole(), begin, end, north_.data(), step_.data());
  std::int16_t* const fill = current_.fill();
  std::int16_t* const hole = current_.hole();
  fill[begin - 1] = surface_.fill()[begin - 1];
  hole[begin - 1] = surface_.hole()[begin - 1];
  take_ranks(ranks, surface_.fill(), begin, end, fill, hole);
  compare_row({fill, hole, surface_.fill(), step_.data(), north_.data()}, begin, end, place_.data(),
              residual_.data(), miss_.data());
  std::copy(fill + begin, fill + end, surface_.fill() + begin);
  std::copy(hole + begin, hole + end, surface_.hole() + begin);
  count(begin, end);
  collect(begin, end);
}

// Contexts of pixels and their ordinals there, and which may be events. No branch depends on what
// is in the image: a wrongly predicted one costs more than all the rest of a pixel. Four parts at
// once, since counting up one number in memory again and again is slow.
void EventCoder::count(int begin, int end) {
  const ContextMap& map = context_map();
  for (int part = 0; part < parts_of(begin, end); ++part) {
    part_pixels_[static_cast<std::size_t>(part)].fill(0);
  }
  const auto one = [&](std::size_t u, std::array<std::uint32_t, kContexts>& pixels) {
    const std::uint8_t context = map[static_cast<std::size_t>(place_[u])];
    context_[u] = context;
    ordinal_[u] = pixels[context]++;
    miss_[u] = static_cast<std::uint8_t>(miss_[u] | forced_[context]);
  };
  const auto first = static_cast<std::size_t>(begin);
  auto rest = first;
  if (parts_of(begin, end) == kParts) {
    const auto part = static_cast<std::size_t>((end - begin) / kParts);
    for (; rest < first + part; ++rest) {
      one(rest, part_pixels_[0]);
      one(rest + part, part_pixels_[1]);
      one(rest + 2 * part, part_pixels_[2]);
      one(rest + 3 * part, part_pixels_[3]);
    }
    rest = first + 4 * part;
  }
  auto& last = part_pixels_[static_cast<std::size_t>(parts_of(begin, end) - 1)];
  for (; rest < static_cast<std::size_t>(end); ++rest) one(rest, last);
  std::fill_n(miss_.begin() + end, kLanes, std::uint8_t{0});
}

void EventCoder::collect(int begin, int end) {
  const int parts = parts_of(begin, end);
  const int length = (end - begin) / parts;
  for (int part = 0; part < parts; ++part) {
    const int from = begin + part * length;
    collect_part(from, part + 1 < parts ? from + length : end);
    const auto& counts = part_pixels_[static_cast<std::size_t>(part)];
    for (std::size_t c = 0; c < kContexts; ++c) pixels_[c] += counts[c];
  }
}

void EventCoder::collect_part(int begin, int end) {
  const std::int16_t* const hole = current_.hole();
  for (int group = begin; group < end; group += 64) {
    std::uint64_t events = 0;
    for (int i = 0; i < 8 && group + 8 * i < end; ++i) {
      events |= bits_of_bytes(miss_.data() + group + 8 * i) << (8 * i);
    }
    if (end - group < 64) events &= (std::uint64_t{1} << (end - group)) - 1;
    for (; events != 0; events &= events - 1) {
      const int u = group + __builtin_ctzll(events);
      const auto column = static_cast<std::size_t>(u);
      const std::size_t context = context_[column];
      add(context, pixels_[context] + ordinal_[column], hole[u] != 0, residual_[column]);
    }
  }
}

void EventCoder::first_row(const std::uint16_t* ranks, const Segment& segment) {
  std::int16_t* const fill = surface_.fill();
  std::int16_t* const hole = surface_.hole();
  for (int u = segment.begin; u < segment.end; ++u) {
    const bool start = u == segment.begin && !segment.west;
    const std::int16_t guess = start ? surface_.last_start() : fill[u - 1];
    const std::size_t context = start ? kStart : hole[u - 1] != 0 ? kNoNorthHole : kNoNorth;
    hole[u] = ranks[u] == 0 ? 1 : 0;
    fill[u] = ranks[u] == 0 ? guess : static_cast<std::int16_t>(ranks[u]);
    if (start) surface_.last_start() = fill[u];
    const std::uint32_t ordinal = pixels_[context]++;
    if (hole[u] != 0 || fill[u] != guess || forced_[context] != 0) {
      add(context, ordinal, hole[u] != 0, static_cast<std::int16_t>(fill[u] - guess));
    }
  }
}

inline void EventCoder::add(std::size_t context, std::uint32_t ordinal, bool hole,
                            std::int16_t residual) {
  const bool usual = context == kInHole ? hole : !hole && residual == 0;
  // Behind a context's first event within the same row.
  if (usual && last_event_[context] != kNone && !direct_[context]) return;
  if (last_event_[context] != kNone) events_[last_event_[context]].run = ordinal - next_[context];
  next_[context] = ordinal + 1;
  last_event_[context] = event_count_;
  forced_[context] = direct_[context] ? 1 : 0;
  const Split split =
      hole ? Split{kHoleSymbol, 0, 0} : split_number(fold(static_cast<std::uint16_t>(residual)));
  events_[event_count_++] = {static_cast<std::uint8_t>(context), split.symbol,
                             static_cast<std::uint16_t>(split.extra), 0};
}

void EventCoder::finish(Histograms& histograms) {
  for (std::size_t c = 0; c < kContexts; ++c) {
    if (last_event_[c] != kNone) events_[last_event_[c]].run = pixels_[c] - next_[c];
  }
  for (auto& histogram : histograms) histogram.fill(0);
  for (std::size_t i = 0; i < event_count_; ++i) {
    const Event& event = events_[i];
    ++histograms[event.context][event.symbol];
    ++histograms[static_cast<std::size_t>(run_table(event.context))]
                [split_number(event.run).symbol];
  }
}

DirectContexts EventCoder::better_direct(const Histograms& histograms) const {
  DirectContexts direct{};
  for (std::size_t c = 0; c < kContexts; ++c) {
    const Histogram& residuals = histograms[c];
    const Histogram& runs = histograms[static_cast<std::size_t>(run_table(static_cast<int>(c)))];
    Histogram every = residuals;
    std::uint32_t events = 0;
    for (const std::uint32_t count : residuals) events += count;
    every[c == kInHole ? std::size_t{kHoleSymbol} : 0] += pixels_[c] - events;
    std::uint64_t run_bits = coded_bits(runs);
    for (int symbol = kDirect; symbol < kSymbols; ++symbol) {
      run_bits += std::uint64_t{runs[static_cast<std::size_t>(symbol)]} *
                  static_cast<std::uint64_t>(extra_bits_of(symbol));
    }
    direct[c] = coded_bits(every) < coded_bits(residuals) + run_bits;
  }
  return direct;
}

}  // namespace rprr::dhcm
