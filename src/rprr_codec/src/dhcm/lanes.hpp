// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

namespace rprr::dhcm {

/// Eight 16-bit lanes in the compilers' portable vector type, which becomes SSE2, NEON or plain
/// code by itself: the same bytes everywhere. Comparisons give 0 or -1 a lane.
using Lanes = std::int16_t __attribute__((vector_size(16)));
constexpr int kLanes = 8;

inline Lanes load(const std::int16_t* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}
inline void store(Lanes lanes, std::int16_t* to) {
  std::memcpy(to, &lanes, sizeof(lanes));
}
/// Eight bytes, each to a lane.
inline Lanes load_bytes(const std::uint8_t* from) {
  using Octets = std::uint8_t __attribute__((vector_size(8)));
  Octets bytes;
  std::memcpy(&bytes, from, sizeof(bytes));
  return __builtin_convertvector(bytes, Lanes);
}
/// The low bytes of the lanes.
inline void store_bytes(Lanes lanes, std::uint8_t* to) {
  using Octets = std::uint8_t __attribute__((vector_size(8)));
  const Octets bytes = __builtin_convertvector(lanes, Octets);
  std::memcpy(to, &bytes, sizeof(bytes));
}
inline Lanes all(int value) {
  const auto v = static_cast<std::int16_t>(value);
  return Lanes{v, v, v, v, v, v, v, v};
}
inline Lanes min(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes max(Lanes a, Lanes b) {
  return a > b ? a : b;
}
inline Lanes select(Lanes mask, Lanes yes, Lanes no) {
  return (mask & yes) | (~mask & no);
}

}  // namespace rprr::dhcm
