// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/model.hpp"

#include "dhcm/lanes.hpp"

namespace rprr::dhcm {
namespace {

int context_of(int north, int west) {
  const bool west_hole = west == kWestHole;
  if (west_hole || north >= kNorthRim) {
    const int holes = (west_hole ? 1 : 0) | (north >= kNorthRim ? north - kNorthRim + 1 : 0) << 1;
    return holes == 7 ? static_cast<int>(kInHole) : kHoleRim + holes - 1;
  }
  // Activity that a north class stands for, by its middle where it is a range.
  static constexpr int kMiddle[kNorthRim - kNorthActivity] = {2, 4, 7, 11, 17, 26, 40};
  const bool pair = north < kNorthFlat;
  const int first = pair ? north / 3 - 1 : 0;
  const int second = pair ? north % 3 - 1 : 0;
  const int step = west - kWestLevel;
  const int activity = std::abs(step) + std::abs(first) + std::abs(second) +
                       (north >= kNorthActivity ? kMiddle[north - kNorthActivity] : 0);
  if (activity == 0) return north == kNorthFlat ? kFlat : kAlmostFlat;
  if (activity == 1) {
    const int place = step != 0 ? 0 : first != 0 ? 2 : 4;
    return kStep + place + (step + first + second < 0 ? 1 : 0);
  }
  static constexpr int kLevelEnds[] = {2, 3, 5, 8, 13, 21, 31};
  int level = 0;
  while (level < 7 && activity > kLevelEnds[level]) ++level;
  return kActivity + level;
}

ContextMap make_context_map() {
  ContextMap map{};
  for (int north = 0; north < kNorthClasses; ++north) {
    for (int west = 0; west < kWestClasses; ++west) {
      map[static_cast<std::size_t>(north * kWestClasses + west)] =
          static_cast<std::uint8_t>(context_of(north, west));
    }
  }
  return map;
}

}  // namespace

const ContextMap& context_map() {
  static const ContextMap map = make_context_map();
  return map;
}

std::uint8_t north_class(const std::int16_t* n, const std::int16_t* hole) {
  if (hole[0] != 0 || hole[1] != 0) {
    return static_cast<std::uint8_t>(kNorthRim - 1 + hole[0] + 2 * hole[1]);
  }
  const int d = static_cast<std::int16_t>(n[0] - n[-1]);
  const int e = static_cast<std::int16_t>(n[1] - n[0]);
  if (std::abs(d) <= 1 && std::abs(e) <= 1) {
    const int pair = 3 * (d + 1) + e + 1;
    return static_cast<std::uint8_t>(pair == kNorthLevel && n[2] == n[1] ? kNorthFlat : pair);
  }
  const int sum = std::abs(d) + std::abs(e);
  return static_cast<std::uint8_t>(kNorthActivity + (sum > 3) + (sum > 5) + (sum > 8) + (sum > 13) +
                                   (sum > 21) + (sum > 31));
}

void classify_north(const std::int16_t* fill, const std::int16_t* hole, int begin, int end,
                    std::uint8_t* north, std::int16_t* step) {
  const Lanes one = all(1);
  for (int u = begin; u < end; u += kLanes) {
    const Lanes n = load(fill + u);
    const Lanes ne = load(fill + u + 1);
    const Lanes d = minus(n, load(fill + u - 1));
    const Lanes e = minus(ne, n);
    store(d, step + u);
    // What is large is held, so that no sum overflows.
    const Lanes held_d = max(min(d, all(50)), all(-50));
    const Lanes held_e = max(min(e, all(50)), all(-50));
    const Lanes size_d = max(held_d, -held_d);
    const Lanes size_e = max(held_e, -held_e);
    const Lanes sum = size_d + size_e;
    const Lanes pair = held_d + held_d + held_d + held_e + all(kNorthLevel);
    const Lanes flat = (sum == 0) & (load(fill + u + 2) == ne);
    const Lanes level = all(kNorthActivity) - (sum > 3) - (sum > 5) - (sum > 8) - (sum > 13) -
                        (sum > 21) - (sum > 31);
    const Lanes even = select(flat, all(kNorthFlat), pair);
    const Lanes small = (size_d <= one) & (size_e <= one);
    const Lanes hole_here = load(hole + u);
    const Lanes hole_east = load(hole + u + 1);
    const Lanes holes = hole_here + hole_east + hole_east;
    const Lanes surface = select(small, even, level);
    store_bytes(select(holes != 0, holes + all(kNorthRim - 1), surface), north + u);
  }
}

void compare_row(const RowView& row, int begin, int end, std::int16_t* place,
                 std::int16_t* residual, std::uint8_t* miss) {
  for (int u = begin; u < end; u += kLanes) {
    const Lanes w = load(row.fill + u - 1);
    const Lanes n = load(row.above + u);
    const Lanes step = load(row.step + u);
    const Lanes guess = min(max(plus(w, step), min(w, n)), max(w, n));
    const Lanes lift = minus(w, minus(n, step));
    const Lanes held = max(min(lift, all(7)), all(-7)) + all(kWestLevel);
    const Lanes west_hole = load(row.hole + u - 1) != 0;
    const Lanes at = load_bytes(row.north + u) * kWestClasses + (held & ~west_hole);
    const Lanes hole = load(row.hole + u) != 0;
    const Lanes difference = minus(load(row.fill + u), guess);
    const Lanes in_hole = at == kNorthHole * kWestClasses + kWestHole;
    store(at, place + u);
    store(difference, residual + u);
    store_bytes(select(in_hole, ~hole, hole | (difference != 0)) & all(1), miss + u);
  }
}

}  // namespace rprr::dhcm
