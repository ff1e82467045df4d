// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/event_reader.hpp"

#include <algorithm>

namespace rprr::dhcm {

void join_tables(const DecodeTable& residuals, const DecodeTable& runs, JointTable& joint) {
  for (std::uint32_t i = 0; i < joint.size(); ++i) {
    const DecodeTable::Entry first = residuals.entries[i];
    const DecodeTable::Entry second = runs.entries[i >> first.length];
    const int length = first.length + second.length;
    const bool hole = first.symbol == kHoleSymbol;
    JointEntry& entry = joint[i];
    entry = {0, second.symbol, static_cast<std::uint8_t>(length)};
    if (length > kMaxCodeLength || second.symbol >= kDirect || (first.symbol >= kDirect && !hole)) {
      entry.bits = kJointNone;
    } else if (hole) {
      entry.bits |= kJointHole;
    } else {
      entry.residual = static_cast<std::int16_t>(unfold(first.symbol));
    }
  }
}

inline DecodedEvent EventReader::event(std::size_t context, BitReader& bits) {
  bits.refill();
  const JointEntry entry = joint_[context][bits.peek(kMaxCodeLength)];
  if ((entry.bits & kJointNone) != 0) {
    BitReader copy = bits;
    const DecodedEvent event = long_event(context, copy);
    bits = copy;
    return event;
  }
  bits.skip(entry.bits & kBitsMask);
  return {entry.residual, (entry.bits & kJointHole) != 0, entry.run};
}

DecodedEvent EventReader::long_event(std::size_t context, BitReader& bits) {
  DecodedEvent event = {0, false, 0};
  const std::uint32_t residual = number(context, bits);
  event.hole = residual == ~0u;
  if (!event.hole) event.residual = static_cast<std::int16_t>(unfold(residual));
  bits.refill();
  event.run = number(kContexts + context, bits);
  return event;
}

// ~0 for the hole symbol of a table of residuals.
std::uint32_t EventReader::number(std::size_t table, BitReader& bits) {
  const DecodeTable::Entry entry = tables_[table].entries[bits.peek(kMaxCodeLength)];
  bits.skip(entry.length);
  if (entry.symbol < kDirect) return entry.symbol;
  if (table < kContexts && entry.symbol >= kHoleSymbol) {
    good_ = good_ && entry.symbol == kHoleSymbol;
    return ~0u;
  }
  const int extra = extra_bits_of(entry.symbol);
  const std::uint32_t value = base_of(entry.symbol) + bits.peek(extra);
  bits.skip(extra);
  return value;
}

namespace {

// How many of the bytes from first on are the same as it, at most limit, of which 7 more can be
// read.
inline int same_bytes(const std::uint8_t* first, int limit) {
  const std::uint64_t pattern = *first * 0x0101010101010101u;
  for (int i = 0; i < limit; i += 8) {
    const std::uint64_t difference = load64(first + i) ^ pattern;
    if (difference != 0) return std::min(limit, i + (__builtin_ctzll(difference) >> 3));
  }
  return limit;
}

}  // namespace

void EventReader::below_known(const Segment& segment, Surface& surface) {
  surface.prepare(segment);
  std::int16_t* const fill = surface.fill();
  std::int16_t* const hole = surface.hole();
  const int end = segment.end;
  classify_north(fill, hole, segment.begin, end, north_.data(), step_.data());
  const std::uint8_t* const north = north_.data();
  const std::int16_t* const step = step_.data();
  const std::uint8_t* const map = context_map().data();
  BitReader bits = bits_;
  std::int16_t w = fill[segment.begin - 1];
  std::int16_t nw = w;
  bool w_hole = hole[segment.begin - 1] != 0;
  for (int u = segment.begin; u < end; ++u) {
    const std::int16_t n = fill[u];
    const int west = w_hole ? kWestHole : west_class(w, nw);
    const std::size_t context = map[north[u] * kWestClasses + west];
    const std::int16_t guess = predict(w, n, step[u]);
    nw = n;
    std::uint32_t& left = left_[context];
    if (left != 0) {
      if (context <= kInHole) {
        // Nothing changes, neither the surface nor the context, while north stays as it is.
        const int limit =
            static_cast<int>(std::min<std::uint32_t>(left, static_cast<std::uint32_t>(end - u)));
        const int same = same_bytes(north + u, limit);
        left -= static_cast<std::uint32_t>(same);
        u += same - 1;
        w = nw = fill[u];
        continue;
      }
      --left;
      w = guess;
      w_hole = false;
      hole[u] = 0;
    } else {
      const DecodedEvent read = event(context, bits);
      left = read.run;
      w_hole = read.hole;
      w = w_hole ? n : static_cast<std::int16_t>(guess + read.residual);
      hole[u] = w_hole ? 1 : 0;
      check(w);
    }
    fill[u] = w;
  }
  bits_ = bits;
}

void EventReader::first_row(const Segment& segment, Surface& surface) {
  std::int16_t* const fill = surface.fill();
  std::int16_t* const hole = surface.hole();
  for (int u = segment.begin; u < segment.end; ++u) {
    const bool start = u == segment.begin && !segment.west;
    const std::int16_t guess = start ? surface.last_start() : fill[u - 1];
    const std::size_t context = start ? kStart : hole[u - 1] != 0 ? kNoNorthHole : kNoNorth;
    fill[u] = guess;
    hole[u] = 0;
    if (left_[context] != 0) {
      --left_[context];
    } else {
      const DecodedEvent read = event(context, bits_);
      left_[context] = read.run;
      hole[u] = read.hole ? 1 : 0;
      if (!read.hole) fill[u] = static_cast<std::int16_t>(guess + read.residual);
      check(fill[u]);
    }
    if (start) surface.last_start() = fill[u];
  }
}

}  // namespace rprr::dhcm
