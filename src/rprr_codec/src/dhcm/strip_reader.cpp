// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/strip_reader.hpp"
#include "rprr_geometry/block_mask.hpp"

#include <algorithm>
#include <cstring>

namespace rprr::dhcm {
namespace {

constexpr int kSetWord = kLongestWord<kSetSymbols>;

bool read_sets(BitReader& bits, StripTables::Sets& sets) {
  SetLengths lengths;
  SetDecodeTable table;
  if (!read_lengths(bits, lengths) || !table.build(lengths)) return false;
  std::transform(table.entries.begin(), table.entries.end(), sets.begin(),
                 [](const SetDecodeTable::Entry& entry) {
                   return static_cast<std::uint16_t>(entry.symbol << 4 | entry.length);
                 });
  return true;
}

// Eight times the places of a set's bits.
using SteppedPlaces = std::array<std::int16_t, kLanes>;
constexpr std::array<SteppedPlaces, 256> make_stepped() {
  std::array<SteppedPlaces, 256> all{};
  for (std::size_t set = 0; set < 256; ++set) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      all[set][i] = static_cast<std::int16_t>(8 * kPlaces[set].at[i]);
    }
  }
  return all;
}
constexpr std::array<SteppedPlaces, 256> kStepped = make_stepped();

// As lanes, 0 or -1.
constexpr std::array<std::array<std::int16_t, kLanes>, 256> make_hole_lanes() {
  std::array<std::array<std::int16_t, kLanes>, 256> all{};
  for (std::size_t set = 0; set < 256; ++set) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      all[set][i] = static_cast<std::int16_t>((set >> i & 1) != 0 ? -1 : 0);
    }
  }
  return all;
}
constexpr auto kHoleLanes = make_hole_lanes();

// A row's share of reading groups.
struct RowReader {
  BitReader bits;
  std::uint16_t* to;          // pixels that are not as guessed
  Lanes first;                // place of the group's first pixel
  std::uint8_t* holes;        // of this row
  const std::uint8_t* above;  // and of the one above
};

inline std::uint16_t set_entry(const StripTables::Sets& table, BitReader& bits) {
  const std::uint16_t entry = table[bits.peek(kSetWord)];
  bits.skip(entry & 15);
  return entry;
}

// False if a symbol means nothing.
inline bool read_group(const StripTables& tables, std::size_t group, RowReader& row) {
  std::uint8_t holes = row.above[group];
  const StripTables::Sets& table = tables.groups[hole_class(holes)];
  std::uint16_t entry = set_entry(table, row.bits);
  if (entry >> 4 == kHolesChange) {
    holes = static_cast<std::uint8_t>(holes ^ set_entry(tables.changes, row.bits) >> 4);
    row.bits.refill();
    entry = set_entry(table, row.bits);
    if (entry >> 4 == kHolesChange) return false;
  }
  row.holes[group] = holes;
  const auto set = static_cast<std::size_t>(entry >> 4);
  const Lanes places = plus(load(kStepped[set].data()), row.first);
  std::memcpy(row.to, &places, sizeof(places));
  row.first = plus(row.first, all(kLanes * kLanes));
  row.to += kSizes[set];
  return true;
}

}  // namespace

bool StripTables::read(BitReader& bits) {
  for (Sets& sets : groups) {
    if (!read_sets(bits, sets)) return false;
  }
  if (!read_sets(bits, changes)) return false;
  CodeLengths lengths;
  DecodeTable table;
  if (!read_lengths(bits, lengths) || !table.build(lengths)) return false;
  std::transform(table.entries.begin(), table.entries.end(), residuals.begin(),
                 [](const DecodeTable::Entry& entry) -> Residual {
                   if (entry.symbol >= kResidualSymbols)
                     return {0, 0, entry.length, entry.length, 1};
                   const int extra = extra_bits_of(entry.symbol);
                   return {static_cast<std::uint16_t>(base_of(entry.symbol)),
                           static_cast<std::uint16_t>((1u << extra) - 1u), entry.length,
                           static_cast<std::uint8_t>(entry.length + extra), 0};
                 });
  find_pairs();
  return true;
}

void StripTables::find_pairs() {
  std::size_t found = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Residual& first = residuals[i];
    const Residual& second = residuals[i >> first.length];
    Pair& pair = pairs[i];
    pair.bits = static_cast<std::uint8_t>(first.length + second.length);
    pair.found = pair.bits <= kMaxCodeLength && (first.extra | second.extra) == 0 &&
                 (first.bad | second.bad) == 0;
    pair.first = static_cast<std::int16_t>(unfold(first.base + 1u));
    pair.second = static_cast<std::int16_t>(unfold(second.base + 1u));
    found += pair.found;
  }
  mostly_pairs = found > pairs.size() / 8 * 5;
}

StripReader::StripReader(const BlockGrid& grid, const BlockMask* mask, std::uint16_t largest)
    : grid_(grid), mask_(mask), largest_(largest) {
  surface_.reset(grid.columns);
  const auto groups = static_cast<std::size_t>(grid.columns);
  // Four rows, and what is written beyond the last one.
  for (auto& places : missed_) places.resize((groups * kStripRows / kStripSides + 1) * kLanes);
  for (auto& row : holes_) row.resize(groups);
  some_.resize(groups);
  every_.resize(groups);
  skewed_.resize((groups * kLanes + kStripRows) * kStripRows);
  skewed_holes_.resize(skewed_.size());
}

bool StripReader::strip(int strip, const StripTables& tables, StripStreams& streams,
                        const StripTarget& target) {
  const int rows = std::min(kStripRows, grid_.height - strip * kStripRows);
  list_segments(grid_, mask_, strip, segments_);
  for (const StripSegment& segment : segments_) {
    surface_.prepare(grid_, mask_, strip, segment);
    missed_count_.fill(0);
    const auto length = static_cast<std::size_t>(segment.end - segment.begin + 1) * 64;
    std::fill_n(skewed_.begin(), length, std::int16_t{0});
    if (any_holes_) std::fill(skewed_holes_.begin(), skewed_holes_.end(), std::int16_t{0});
    for (int k = 0; k < rows; k += 2) read_rows(segment, k, k + 1 < rows, tables, streams);
    read_residuals(tables, streams);
    place_holes(segment, rows);
    const std::int16_t* const fill = surface_.fill.data();
    surface_.last = fill[segment.begin * kLanes];
    for (const StripSegment& part : parts_) {
      const std::size_t from = static_cast<std::size_t>(part.begin - segment.begin) * 64;
      const bool first = part.begin == segment.begin;
      const std::int16_t top_left =
          any_holes_ ? rebuild<true>(part, from) : rebuild<false>(part, from);
      if (first) surface_.last = top_left;
    }
    if (!good_) return false;
    write(segment, rows, target);
  }
  return true;
}

// Two rows at once where there are two: their streams do not wait for each other.
void StripReader::read_rows(const StripSegment& segment, int row, bool pair,
                            const StripTables& tables, StripStreams& streams) {
  const auto k = static_cast<std::size_t>(row);
  const std::uint8_t* const above = k == 0 ? surface_.holes.data() : holes_[k - 1].data();
  RowReader even = {streams[0], missed_[0].data() + missed_count_[0], all(row), holes_[k].data(),
                    above};
  const auto begin = static_cast<std::size_t>(segment.begin);
  const auto end = static_cast<std::size_t>(segment.end);
  bool good = true;
  if (pair) {
    RowReader odd = {streams[1], missed_[1].data() + missed_count_[1], all(row + 1),
                     holes_[k + 1].data(), holes_[k].data()};
    std::size_t g = begin;
    // Two groups a refill, which is enough for both.
    for (; g + 2 <= end; g += 2) {
      even.bits.refill();
      odd.bits.refill();
      good &= read_group(tables, g, even);
      good &= read_group(tables, g, odd);
      good &= read_group(tables, g + 1, even);
      good &= read_group(tables, g + 1, odd);
    }
    if (g < end) {
      even.bits.refill();
      odd.bits.refill();
      good &= read_group(tables, g, even);
      good &= read_group(tables, g, odd);
    }
    streams[1] = odd.bits;
    missed_count_[1] = static_cast<std::size_t>(odd.to - missed_[1].data());
  } else {
    for (std::size_t g = begin; g < end; ++g) {
      even.bits.refill();
      good &= read_group(tables, g, even);
    }
  }
  streams[0] = even.bits;
  missed_count_[0] = static_cast<std::size_t>(even.to - missed_[0].data());
  good_ = good_ && good;
}

namespace {

// Places that stand for 8 times the column and the row.
inline void put_residual(std::int16_t* skewed, std::size_t place, std::int16_t residual) {
  skewed[place + (place & 7) * 8] = residual;
}

// Takes at most 24 bits.
inline unsigned read_residual(const StripTables& tables, BitReader& bits, std::size_t place,
                              std::int16_t* skewed) {
  const StripTables::Residual& entry = tables.residuals[bits.peek(kMaxCodeLength)];
  const std::uint32_t number =
      entry.base + (bits.peek(kMaxCodeLength + 16) >> entry.length & entry.extra);
  bits.skip(entry.bits);
  put_residual(skewed, place, static_cast<std::int16_t>(unfold(number + 1)));
  return entry.bad;
}

// Takes at most 10 bits, or refills afterwards.
inline unsigned read_pair(const StripTables& tables, BitReader& bits, const std::uint16_t* places,
                          std::int16_t* skewed) {
  const StripTables::Pair& pair = tables.pairs[bits.peek(kMaxCodeLength)];
  if (pair.found == 0) {
    unsigned bad = read_residual(tables, bits, places[0], skewed);
    bad |= read_residual(tables, bits, places[1], skewed);
    bits.refill();
    return bad;
  }
  bits.skip(pair.bits);
  put_residual(skewed, places[0], pair.first);
  put_residual(skewed, places[1], pair.second);
  return 0;
}

}  // namespace

// Both sides at once while both have some: their streams do not wait for each other.
void StripReader::read_residuals(const StripTables& tables, StripStreams& streams) {
  BitReader even = streams[2];
  BitReader odd = streams[3];
  const std::uint16_t* const e = missed_[0].data();
  const std::uint16_t* const o = missed_[1].data();
  const std::size_t both = std::min(missed_count_[0], missed_count_[1]);
  std::int16_t* const skewed = skewed_.data();
  unsigned bad = 0;
  std::size_t i = 0;
  if (tables.mostly_pairs) {
    for (; i + 4 <= both; i += 4) {
      even.refill();
      odd.refill();
      bad |= read_pair(tables, even, e + i, skewed);
      bad |= read_pair(tables, odd, o + i, skewed);
      bad |= read_pair(tables, even, e + i + 2, skewed);
      bad |= read_pair(tables, odd, o + i + 2, skewed);
    }
  }
  for (; i + 2 <= both; i += 2) {
    even.refill();
    odd.refill();
    bad |= read_residual(tables, even, e[i], skewed);
    bad |= read_residual(tables, odd, o[i], skewed);
    bad |= read_residual(tables, even, e[i + 1], skewed);
    bad |= read_residual(tables, odd, o[i + 1], skewed);
  }
  const auto rest = [&](BitReader& bits, const std::uint16_t* places, std::size_t count) {
    for (std::size_t j = i; j < count; ++j) {
      bits.refill();
      bad |= read_residual(tables, bits, places[j], skewed);
    }
  };
  rest(even, e, missed_count_[0]);
  rest(odd, o, missed_count_[1]);
  streams[2] = even;
  streams[3] = odd;
  good_ = good_ && bad == 0;
}

// Which pixels are without reading, and the parts of the segment that have any reading at all.
void StripReader::place_holes(const StripSegment& segment, int rows) {
  const auto begin = static_cast<std::size_t>(segment.begin);
  const auto end = static_cast<std::size_t>(segment.end);
  std::copy(holes_[0].begin(), holes_[0].end(), some_.begin());
  std::copy(holes_[0].begin(), holes_[0].end(), every_.begin());
  for (std::size_t k = 1; k < static_cast<std::size_t>(rows); ++k) {
    for (std::size_t g = begin; g < end; ++g) {
      some_[g] |= holes_[k][g];
      every_[g] &= holes_[k][g];
    }
  }
  any_holes_ = false;
  parts_.clear();
  for (std::size_t g = begin; g < end; ++g) {
    if (every_[g] == 255) continue;
    const int column = static_cast<int>(g);
    if (parts_.empty() || parts_.back().end != column) parts_.push_back({column, column});
    ++parts_.back().end;
    if (some_[g] == 0) continue;
    any_holes_ = true;
    for (std::size_t k = 0; k < static_cast<std::size_t>(rows); ++k) {
      std::int16_t* const to = skewed_holes_.data() + (g - begin) * 64 + 9 * k;
      const std::int16_t* const lanes = kHoleLanes[holes_[k][g]].data();
      for (int i = 0; i < kLanes; ++i) to[8 * i] = lanes[i];
    }
  }
  const std::vector<std::uint8_t>& last = holes_[static_cast<std::size_t>(rows - 1)];
  std::copy(last.begin() + segment.begin, last.begin() + segment.end,
            surface_.holes.begin() + segment.begin);
}

// Eight rows at once. What a pixel is predicted from was made one and two steps before. Left of a
// part, and right of it, is nothing or blocks without any reading, which leave the surface as it
// is: both predict a row's first pixel as the one above it, and what is written there is not read.
template <bool kHoles>
std::int16_t StripReader::rebuild(const StripSegment& part, std::size_t from) {
  std::int16_t* const surface = surface_.fill.data() + part.begin * kLanes;
  std::int16_t* const skewed = skewed_.data() + from;
  const std::int16_t* const holes = skewed_holes_.data() + from;
  const int columns = (part.end - part.begin) * kLanes;
  std::int16_t top_left = 0;
  Lanes lowest = all(0);
  Lanes highest = all(0);
  Lanes x = all(0);
  Lanes n = all(0);
  const auto step = [&](int t, Lanes w, Lanes nw) {
    const Lanes guess = min(max(plus(n, minus(w, nw)), min(w, n)), max(w, n));
    const Lanes residual = load(skewed + 8 * t);
    Lanes seen = x = plus(guess, residual);
    if (kHoles) {
      const Lanes hole = load(holes + 8 * t);
      x = select(hole, n, x);
      seen = x & ~hole;
    }
    lowest = min(lowest, seen);
    highest = max(highest, seen);
    store(seen, skewed + 8 * t);
  };
  int t = 0;
  for (; t < kStripRows; ++t) {
    const Lanes starts = Lanes{0, 1, 2, 3, 4, 5, 6, 7} == all(t);
    const Lanes nw = n;
    n = shift_in(surface[t], x);
    step(t, select(starts, n, x), select(starts, n, nw));
    if (t == 0) top_left = x[0];
  }
  surface[0] = x[kLanes - 1];
  for (; t < columns + kStripRows - 1; ++t) {
    const Lanes nw = n;
    n = shift_in(surface[std::min(t, columns - 1)], x);
    step(t, x, nw);
    surface[t - kStripRows + 1] = x[kLanes - 1];
  }
  if (largest_ < 32768) check(lowest, highest);
  return top_left;
}

// A guess lies between two ranks, as signed numbers: none is beyond those that were decoded.
void StripReader::check(Lanes lowest, Lanes highest) {
  for (int i = 0; i < kLanes; ++i) {
    good_ = good_ && lowest[i] >= 0 && highest[i] <= static_cast<int>(largest_);
  }
}

void StripReader::write(const StripSegment& segment, int rows, const StripTarget& target) const {
  int written = segment.begin * kLanes;
  const auto clear = [&](int end) {
    for (int k = 0; k < rows && written < end; ++k) {
      std::uint16_t* const row = target.first + static_cast<std::size_t>(k) * target.stride;
      std::fill(row + written, row + end, std::uint16_t{0});
    }
  };
  for (const StripSegment& part : parts_) {
    clear(part.begin * kLanes);
    write_part(part, static_cast<std::size_t>(part.begin - segment.begin) * 64, rows, target);
    written = std::min(part.end * kLanes, grid_.width);
  }
  clear(std::min(segment.end * kLanes, grid_.width));
}

void StripReader::write_part(const StripSegment& part, std::size_t from, int rows,
                             const StripTarget& target) const {
  const int begin = part.begin * kLanes;
  const int count = std::min(part.end * kLanes, grid_.width) - begin;
  const auto* const ranks = reinterpret_cast<const std::uint16_t*>(skewed_.data()) + from;
  for (int k = 0; k < rows; ++k) {
    std::uint16_t* const out = target.first + static_cast<std::size_t>(k) * target.stride + begin;
    const std::uint16_t* const row = ranks + 9 * k;
    int u = 0;
    if (target.values == nullptr) {
      for (; u < count; ++u) out[u] = row[8 * u];
      continue;
    }
    for (; u + kLanes <= count; u += kLanes) {
      for (int i = 0; i < kLanes; ++i) out[u + i] = target.values[row[8 * (u + i)]];
    }
    for (; u < count; ++u) out[u] = target.values[row[8 * u]];
  }
}

}  // namespace rprr::dhcm
