// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>

#include "dhcm/strips.hpp"
#include "dhcm/tables.hpp"
#include "rprr_geometry/block_mask.hpp"

namespace rprr::dhcm {
namespace {

constexpr int kClassShift = 8;
constexpr std::uint16_t kChangeMark = 1u << 10;
// The longest code words and plain bits of a group and of a residual, in bytes.
constexpr std::size_t kGroupBytes = (3 * kLongestWord<kSetSymbols> + 7) / 8;
constexpr std::size_t kResidualBytes = (kMaxCodeLength + 14 + 7) / 8;

// Residuals are never 0: what is as guessed stands in no stream of residuals.
Split split_residual(std::uint16_t residual) {
  return split_number(fold(residual) - 1);
}

// Residuals that are near 0 by themselves, since there are few others.
constexpr std::size_t kNear = 256;
std::size_t near_index(std::uint16_t residual) {
  return static_cast<std::uint16_t>(residual + kNear);
}

// From so many groups on, tables that are fitted to half of them are good enough.
constexpr std::size_t kLeastForHalf = 4096;

struct Bits {
  std::uint32_t value;
  std::uint32_t count;
};

Bits residual_bits(std::uint16_t residual, const EncodeTable& table) {
  const Split split = split_residual(residual);
  const EncodeTable::Word& word = table.words[split.symbol];
  return {word.code | split.extra << word.length,
          static_cast<std::uint32_t>(word.length) + split.extra_bits};
}

}  // namespace

void StripCoder::begin(const BlockGrid& grid, const BlockMask* mask) {
  grid_ = grid;
  mask_ = mask;
  surface_.reset(grid.columns);
  for (Side& side : sides_) side.group_count = side.change_count = side.residual_count = 0;
  const auto columns = static_cast<std::size_t>(grid.columns);
  fill_.resize(columns * kLanes + 1);
  holes_.resize(columns);
  residual_.resize(columns * kLanes);
  missed_.resize(columns);
}

void StripCoder::strip(const std::uint16_t* ranks, std::size_t stride, int strip) {
  const int rows = std::min(kStripRows, grid_.height - strip * kStripRows);
  list_segments(grid_, mask_, strip, segments_);
  for (const StripSegment& segment : segments_) {
    surface_.prepare(grid_, mask_, strip, segment);
    for (int k = 0; k < rows; ++k) {
      compare(ranks + static_cast<std::size_t>(k) * stride, segment);
      collect(segment, sides_[static_cast<std::size_t>(k) % kStripSides]);
      if (k == 0) {
        surface_.last = surface_.fill[static_cast<std::size_t>(segment.begin) * kLanes];
      }
    }
  }
}

bool StripCoder::quiet() const {
  std::size_t groups = 0;
  std::size_t others = 0;
  for (const Side& side : sides_) {
    groups += side.group_count;
    others += side.residual_count + side.change_count;
  }
  return 16 * others < groups;
}

// Residuals of a row, which of them count, and its holes. Its surface takes the place of the one
// above.
void StripCoder::compare(const std::uint16_t* ranks, const StripSegment& segment) {
  std::int16_t* const above = surface_.fill.data();
  std::int16_t* const fill = fill_.data() + 1;
  const int begin = segment.begin * kLanes;
  const int end = segment.end * kLanes;
  for (int u = begin; u < end; u += kLanes) {
    Lanes rank;
    std::memcpy(&rank, ranks + u, sizeof(rank));
    const Lanes none = rank == 0;
    store(select(none, load(above + u), rank), fill + u);
    holes_[static_cast<std::size_t>(u / kLanes)] = bits_of_lanes(none);
  }
  // The first pixel is predicted as the one above it.
  std::int16_t before = fill[begin - 1] = above[begin];
  for (int u = begin; u < end; u += kLanes) {
    const Lanes n = load(above + u);
    const Lanes nw = shift_in(before, n);
    const Lanes w = load(fill + u - 1);
    const Lanes x = load(fill + u);
    const Lanes guess = min(max(plus(w, minus(n, nw)), min(w, n)), max(w, n));
    const Lanes residual = minus(x, guess);
    before = n[kLanes - 1];
    store(residual, residual_.data() + u);
    const auto group = static_cast<std::size_t>(u / kLanes);
    missed_[group] = static_cast<std::uint8_t>(bits_of_lanes(residual != 0) & ~holes_[group]);
    store(x, above + u);
  }
  if (end > grid_.width) {
    // Beyond the rim all is as guessed.
    const auto inside = static_cast<std::uint8_t>((1u << grid_.width % kLanes) - 1u);
    missed_[static_cast<std::size_t>(segment.end - 1)] &= inside;
    holes_[static_cast<std::size_t>(segment.end - 1)] &= inside;
  }
}

// Without branches on what is in the image, but for holes that change: a wrongly predicted one
// costs more than all the rest of a group.
void StripCoder::collect(const StripSegment& segment, Side& side) {
  const auto most = static_cast<std::size_t>(grid_.columns);
  if (side.groups.size() < side.group_count + most) {
    side.groups.resize(2 * side.group_count + most);
    side.changes.resize(2 * side.group_count + most);
  }
  if (side.residuals.size() < side.residual_count + (most + 1) * kLanes) {
    side.residuals.resize(2 * side.residual_count + (most + 1) * kLanes);
  }
  std::uint16_t* group_to = side.groups.data() + side.group_count;
  std::uint16_t* to = side.residuals.data() + side.residual_count;
  for (auto g = static_cast<std::size_t>(segment.begin); g < static_cast<std::size_t>(segment.end);
       ++g) {
    const std::uint8_t old_holes = surface_.holes[g];
    const auto change = static_cast<std::uint8_t>(old_holes ^ holes_[g]);
    const std::uint8_t set = missed_[g];
    *group_to++ = static_cast<std::uint16_t>(set | hole_class(old_holes) << kClassShift |
                                             (change != 0 ? kChangeMark : 0u));
    if (change != 0) {
      side.changes[side.change_count++] = change;
      surface_.holes[g] = holes_[g];
    }
    const std::int16_t* const from = residual_.data() + g * kLanes;
    const Places& places = kPlaces[set];
    for (int i = 0; i < 3; ++i) to[i] = static_cast<std::uint16_t>(from[places.at[i]]);
    if (kSizes[set] > 3) {
      for (int i = 3; i < kLanes; ++i) to[i] = static_cast<std::uint16_t>(from[places.at[i]]);
    }
    to += kSizes[set];
  }
  side.group_count = static_cast<std::size_t>(group_to - side.groups.data());
  side.residual_count = static_cast<std::size_t>(to - side.residuals.data());
}

namespace {

SetEncodeTable write_set_table(const SetHistogram& histogram, BitWriter& head) {
  const SetLengths lengths = code_lengths(histogram);
  write_lengths(lengths, head);
  return SetEncodeTable(lengths);
}

}  // namespace

StripCoder::GroupTables StripCoder::write_group_tables(bool half, BitWriter& head) const {
  // One of each for a side, since the same number counted up twice in a row is slow.
  std::array<std::array<SetHistogram, kHoleClasses + 1>, kStripSides> counts{};
  for (std::size_t s = 0; s < (half ? 1 : kStripSides); ++s) {
    const Side& side = sides_[s];
    for (std::size_t i = 0; i < side.group_count; ++i) {
      const std::uint16_t group = side.groups[i];
      SetHistogram& histogram = counts[s][group >> kClassShift & 3u];
      ++histogram[group & 255u];
      if ((group & kChangeMark) != 0) ++histogram[kHolesChange];
    }
    for (std::size_t i = 0; i < side.change_count; ++i) ++counts[s][kHoleClasses][side.changes[i]];
  }
  GroupTables tables;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    for (std::size_t i = 0; i < kSetSymbols; ++i)
      counts[0][t][i] += counts[1][t][i] + (half ? 1 : 0);
    tables[t] = write_set_table(counts[0][t], head);
  }
  return tables;
}

EncodeTable StripCoder::write_residual_table(bool half, BitWriter& head) const {
  std::array<std::array<std::uint32_t, 2 * kNear + 1>, 4> near{};
  Histogram numbers{};
  if (half) std::fill_n(numbers.begin(), kResidualSymbols, 1u);
  for (std::size_t s = 0; s < (half ? 1 : kStripSides); ++s) {
    const Side& side = sides_[s];
    const auto count = [&](std::size_t i, std::size_t part) {
      const std::size_t index = near_index(side.residuals[i]);
      ++near[part][std::min(index, 2 * kNear)];
      if (index >= 2 * kNear) ++numbers[split_residual(side.residuals[i]).symbol];
    };
    std::size_t i = 0;
    for (; i + 4 <= side.residual_count; i += 4) {
      for (std::size_t part = 0; part < 4; ++part) count(i + part, part);
    }
    for (; i < side.residual_count; ++i) count(i, 0);
  }
  for (std::size_t i = 0; i < 2 * kNear; ++i) {
    if (i == kNear) continue;
    numbers[split_residual(static_cast<std::uint16_t>(i - kNear)).symbol] +=
        near[0][i] + near[1][i] + near[2][i] + near[3][i];
  }
  const CodeLengths lengths = code_lengths(numbers);
  write_lengths(lengths, head);
  return EncodeTable(lengths);
}

void StripCoder::write_groups(const Side& side, const GroupTables& tables, Stream& stream) {
  PlainBitWriter bits(stream.room(side.group_count * kGroupBytes));
  const std::uint8_t* change = side.changes.data();
  for (std::size_t i = 0; i < side.group_count; ++i) {
    const std::uint16_t group = side.groups[i];
    const SetEncodeTable& table = tables[group >> kClassShift & 3u];
    if ((group & kChangeMark) != 0) {
      const SetEncodeTable::Word& mark = table.words[kHolesChange];
      const SetEncodeTable::Word& word = tables[kHoleClasses].words[*change++];
      bits.put(mark.code | std::uint32_t{word.code} << mark.length, mark.length + word.length);
    }
    const SetEncodeTable::Word& word = table.words[group & 255u];
    bits.put(word.code, word.length);
  }
  stream.close(bits);
}

void StripCoder::write_residuals(const Side& side, const EncodeTable& table, Stream& stream) {
  std::array<Bits, 2 * kNear> near{};
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (i != kNear) near[i] = residual_bits(static_cast<std::uint16_t>(i - kNear), table);
  }
  const auto bits_of = [&](std::uint16_t residual) {
    const std::size_t index = near_index(residual);
    return index < near.size() ? near[index] : residual_bits(residual, table);
  };
  PlainBitWriter bits(stream.room(side.residual_count * kResidualBytes));
  std::size_t i = 0;
  for (; i + 2 <= side.residual_count; i += 2) {
    const Bits first = bits_of(side.residuals[i]);
    const Bits second = bits_of(side.residuals[i + 1]);
    bits.put(first.value | std::uint64_t{second.value} << first.count,
             static_cast<int>(first.count + second.count));
  }
  if (i < side.residual_count) {
    const Bits one = bits_of(side.residuals[i]);
    bits.put(one.value, static_cast<int>(one.count));
  }
  stream.close(bits);
}

void StripCoder::write(bool quick, BitWriter& head) {
  const bool half = quick && sides_[1].group_count >= kLeastForHalf;
  const GroupTables groups = write_group_tables(half, head);
  const EncodeTable residuals = write_residual_table(half, head);
  for (std::size_t s = 0; s < kStripSides; ++s) {
    write_groups(sides_[s], groups, streams_[s]);
    write_residuals(sides_[s], residuals, streams_[kStripSides + s]);
  }
}

}  // namespace rprr::dhcm
