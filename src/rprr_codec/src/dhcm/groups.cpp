// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/groups.hpp"

#include <algorithm>
#include <cstring>

namespace rprr::dhcm {
namespace {

using Unsigned = std::uint16_t __attribute__((vector_size(16)));

// Residuals 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
Lanes fold_lanes(Lanes residual) {
  return (residual + residual) ^ (residual < 0);
}
Lanes unfold_lanes(Lanes folded) {
  const auto half = reinterpret_cast<Lanes>(reinterpret_cast<Unsigned>(folded) >> 1);
  return half ^ -(folded & all(1));
}

// Whether the row starts a block whose northern neighbour was not sent is known by column; rows
// inside of blocks always have a row above.
void forget_unsent(const BlockGrid& grid, const BlockMask* mask, int v, GroupSurface& surface) {
  if (mask == nullptr || v % kBlockSide != 0 || v == 0) return;
  for (int column = 0; column < grid.columns; ++column) {
    const int above = grid.index(column, v / kBlockSide - 1);
    surface.known[static_cast<std::size_t>(column)] = (*mask)[above] ? 1 : 0;
  }
}

bool is_sent(const BlockGrid& grid, const BlockMask* mask, int column, int v) {
  return mask == nullptr || (*mask)[grid.index(column, v / kBlockSide)];
}

// 0 or -1 a lane.
Lanes lanes_of_bits(std::uint8_t bits) {
  const Lanes places = {1, 2, 4, 8, 16, 32, 64, 128};
  return (all(bits) & places) != 0;
}
// The bits that are set in any lane.
unsigned any_of_lanes(Lanes lanes) {
  std::uint64_t halves[2];
  std::memcpy(halves, &lanes, sizeof(halves));
  std::uint64_t all_bits = halves[0] | halves[1];
  all_bits |= all_bits >> 32;
  all_bits |= all_bits >> 16;
  return static_cast<unsigned>(all_bits & 0xFFFFu);
}

constexpr std::array<std::uint8_t, 256> make_kinds() {
  std::array<std::uint8_t, 256> kinds{};
  kinds[2] = kUpOnly;
  kinds[1] = kDownOnly;
  int width = 2;
  for (unsigned bits = 3; bits < 256; ++bits) {
    while (bits >> width != 0) ++width;
    kinds[bits] = static_cast<std::uint8_t>(kNarrow + width - 2);
  }
  return kinds;
}

// By the bits that are set in any residual; from a table since it is hard to foresee.
int kind_of(unsigned bits) {
  static constexpr std::array<std::uint8_t, 256> kKinds = make_kinds();
  return bits < 256 ? static_cast<int>(kKinds[bits]) : static_cast<int>(kWide);
}

// The residuals of kinds up to kNarrow side by side, in no, one or two bits each. Without branches:
// which kind it is is hard to foresee.
std::uint32_t narrow_bits(const std::array<std::uint16_t, kLanes>& residuals, int kind) {
  static constexpr std::int16_t kPlaces[2][kLanes] = {{1, 2, 4, 8, 16, 32, 64, 128},
                                                      {1, 4, 16, 64, 256, 1024, 4096, 16384}};
  Lanes lanes;
  std::memcpy(&lanes, residuals.data(), sizeof(lanes));
  const std::uint32_t bits = any_of_lanes(lanes * load(kPlaces[kind == kNarrow ? 1 : 0]));
  const std::uint32_t used = (1u << (kLanes * bits_of_kind(kind))) - 1u;
  return bits >> (kind == kUpOnly ? 1 : 0) & used;
}

// Without a row above, each pixel is a difference to the one before.
Lanes differences(const Lanes& fill, std::int16_t before) {
  std::int16_t values[kLanes + 1] = {before};
  store(fill, values + 1);
  return fill - load(values);
}
Lanes sums(const Lanes& residual, std::int16_t before) {
  std::int16_t values[kLanes];
  store(residual, values);
  for (std::int16_t& value : values) before = value = static_cast<std::int16_t>(before + value);
  return load(values);
}
// The pixels without reading as the one before them, or as the last one known.
Lanes fill_along(const Lanes& ranks, std::int16_t before) {
  std::int16_t values[kLanes];
  store(ranks, values);
  for (std::int16_t& value : values) before = value = value == 0 ? before : value;
  return load(values);
}

}  // namespace

void GroupSurface::reset(int columns) {
  const auto groups = static_cast<std::size_t>(columns);
  fill.assign(groups * kLanes, 0);
  holes.assign(groups, 0);
  category.assign(groups, 3);
  known.assign(groups, 0);
  last = 0;
}

void GroupCoder::begin(const BlockGrid& grid, const BlockMask* mask) {
  grid_ = grid;
  mask_ = mask;
  surface_.reset(grid.columns);
  const std::size_t most =
      static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.height);
  if (groups_.size() < most) groups_.resize(most);
  if (residuals_.size() < most + 1) residuals_.resize(most + 1);
  group_count_ = 0;
  residual_count_ = 0;
}

void GroupCoder::row(const std::uint16_t* ranks, int v) {
  forget_unsent(grid_, mask_, v, surface_);
  bool west = false;
  for (int column = 0; column < grid_.columns; ++column) {
    const bool sent = is_sent(grid_, mask_, column, v);
    if (sent) {
      group(ranks + column * kLanes, static_cast<std::size_t>(column), west);
    }
    west = sent;
  }
}

inline void GroupCoder::group(const std::uint16_t* ranks, std::size_t column, bool west) {
  Lanes rank;
  std::memcpy(&rank, ranks, sizeof(rank));
  std::int16_t* const above = surface_.fill.data() + column * kLanes;
  const std::size_t context = surface_.context(column, west);
  const Lanes hole = rank == 0;
  const bool north = surface_.known[column] != 0;
  const Lanes fill = north ? select(hole, load(above), rank) : fill_along(rank, surface_.last);
  const Lanes residual = north ? fill - load(above) : differences(fill, surface_.last);
  const Lanes folded = fold_lanes(residual);
  const int kind = kind_of(any_of_lanes(folded));
  const std::uint8_t holes = bits_of_lanes(hole);
  const auto changed = static_cast<std::uint8_t>(holes ^ surface_.holes[column]);
  groups_[group_count_++] = {static_cast<std::uint8_t>(context),
                             static_cast<std::uint8_t>(2 * kind + (changed != 0 ? 1 : 0)), changed,
                             0};
  // Written in any case, kept where it is needed: no branch.
  std::memcpy(residuals_[residual_count_].data(), &folded, sizeof(folded));
  residual_count_ += kind != kSame ? 1 : 0;
  store(fill, above);
  surface_.holes[column] = holes;
  surface_.category[column] = category_of(kind);
  surface_.known[column] = 1;
  surface_.last = above[kLanes - 1];
}

void GroupCoder::count(std::array<Histogram, kGroupContexts>& histograms) const {
  for (auto& histogram : histograms) histogram.fill(0);
  for (std::size_t i = 0; i < group_count_; ++i) {
    ++histograms[groups_[i].context][groups_[i].symbol];
  }
}

void GroupCoder::write(const std::array<EncodeTable, kGroupContexts>& tables,
                       BitWriter& bits) const {
  std::size_t next = 0;
  for (std::size_t g = 0; g < group_count_; ++g) {
    const Group& group = groups_[g];
    const EncodeTable::Word& word = tables[group.context].words[group.symbol];
    bits.put(word.code | static_cast<std::uint32_t>(group.holes) << word.length,
             word.length + ((group.symbol & 1) != 0 ? 8 : 0));
    const int kind = group.symbol / 2;
    const auto& residuals = residuals_[next];
    next += kind != kSame ? 1 : 0;
    const int width = bits_of_kind(kind);
    if (kind <= kNarrow) {
      bits.put(narrow_bits(residuals, kind), kLanes * width);
      continue;
    }
    for (int half = 0; half < kLanes; half += 4) {
      std::uint64_t value = 0;
      for (int i = 3; i >= 0; --i) {
        value = value << width | residuals[static_cast<std::size_t>(half + i)];
      }
      bits.put(static_cast<std::uint32_t>(value), std::min(4 * width, 32));
      if (width == 16) bits.put(static_cast<std::uint32_t>(value >> 32), 32);
    }
  }
}

GroupReader::GroupReader(const BlockGrid& grid, const BlockMask* mask, std::uint16_t largest)
    : grid_(grid), mask_(mask), largest_(largest) {
  surface_.reset(grid.columns);
}

inline Lanes GroupReader::residuals(int kind, BitReader& bits) {
  const int width = bits_of_kind(kind);
  if (width <= 2) {
    const Lanes one = {128, 64, 32, 16, 8, 4, 2, 1};
    const Lanes two = {16384, 4096, 1024, 256, 64, 16, 4, 1};
    const Lanes word = all(static_cast<int>(bits.peek(8 * width)));
    bits.skip(8 * width);
    if (width == 2) return reinterpret_cast<Lanes>(reinterpret_cast<Unsigned>(word * two) >> 14);
    const auto set = reinterpret_cast<Lanes>(reinterpret_cast<Unsigned>(word * one) >> 7) & all(1);
    return kind == kUpOnly ? set + set : set;
  }
  std::int16_t values[kLanes];
  for (int half = 0; half < kLanes; half += 4) {
    bits.refill();
    for (int i = 0; i < 4; ++i) {
      if (width == 16 && i == 2) bits.refill();
      values[half + i] = static_cast<std::int16_t>(bits.peek(width));
      bits.skip(width);
    }
  }
  return load(values);
}

bool GroupReader::row(int v, const std::vector<DecodeTable>& tables, const std::uint16_t* values,
                      BitReader& stream, std::uint16_t* out) {
  forget_unsent(grid_, mask_, v, surface_);
  BitReader bits = stream;
  const Unsigned largest = reinterpret_cast<Unsigned>(all(largest_));
  Lanes bad = all(0);
  bool west = false;
  for (int c = 0; c < grid_.columns; ++c) {
    const bool sent = is_sent(grid_, mask_, c, v);
    const bool had_west = west;
    west = sent;
    if (!sent) continue;
    const auto column = static_cast<std::size_t>(c);
    std::int16_t* const fill = surface_.fill.data() + column * kLanes;
    bits.refill();
    const DecodeTable::Entry entry =
        tables[surface_.context(column, had_west)].entries[bits.peek(kMaxCodeLength)];
    bits.skip(entry.length);
    if (entry.symbol >= kGroupSymbols) return false;
    if ((entry.symbol & 1) != 0) {
      surface_.holes[column] = static_cast<std::uint8_t>(surface_.holes[column] ^ bits.peek(8));
      bits.skip(8);
    }
    const int kind = entry.symbol >> 1;
    Lanes lanes = load(fill);
    if (kind != kSame || surface_.known[column] == 0) {
      const Lanes residual = kind == kSame ? all(0) : unfold_lanes(residuals(kind, bits));
      lanes = surface_.known[column] != 0 ? lanes + residual : sums(residual, surface_.last);
      store(lanes, fill);
      bad |= reinterpret_cast<Lanes>(reinterpret_cast<Unsigned>(lanes) > largest);
    }
    surface_.category[column] = category_of(kind);
    surface_.known[column] = 1;
    surface_.last = fill[kLanes - 1];
    if (any_of_lanes(bad) != 0) return false;
    if (values != nullptr) {
      std::int16_t looked_up[kLanes];
      for (int i = 0; i < kLanes; ++i) {
        looked_up[i] = static_cast<std::int16_t>(values[static_cast<std::uint16_t>(fill[i])]);
      }
      lanes = load(looked_up);
    }
    lanes &= ~lanes_of_bits(surface_.holes[column]);
    std::memcpy(out + column * kLanes, &lanes, sizeof(lanes));
  }
  stream = bits;
  return true;
}

}  // namespace rprr::dhcm
