// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

#include "dhcm/bit_io.hpp"

namespace rprr::dhcm {

/// Eight 16-bit lanes in the compilers' portable vector type, which becomes SSE2, NEON or plain
/// code by itself: the same bytes everywhere. Comparisons give 0 or -1 a lane.
using Lanes = std::int16_t __attribute__((vector_size(16)));
using UnsignedLanes = std::uint16_t __attribute__((vector_size(16)));
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
/// Sums and differences modulo 2^16: those of signed lanes must not overflow.
inline Lanes plus(Lanes a, Lanes b) {
  return reinterpret_cast<Lanes>(reinterpret_cast<UnsignedLanes>(a) +
                                 reinterpret_cast<UnsignedLanes>(b));
}
inline Lanes minus(Lanes a, Lanes b) {
  return reinterpret_cast<Lanes>(reinterpret_cast<UnsignedLanes>(a) -
                                 reinterpret_cast<UnsignedLanes>(b));
}
inline Lanes min(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes max(Lanes a, Lanes b) {
  return a > b ? a : b;
}
/// The lanes, each one further up, and first in the lowest.
inline Lanes shift_in(std::int16_t first, Lanes lanes) {
  const Lanes low = {first, 0, 0, 0, 0, 0, 0, 0};
#if defined(__clang__)
  return low | __builtin_shufflevector(lanes, Lanes{}, 8, 0, 1, 2, 3, 4, 5, 6);
#else
  return low | __builtin_shuffle(lanes, Lanes{}, Lanes{8, 0, 1, 2, 3, 4, 5, 6});
#endif
}
inline Lanes select(Lanes mask, Lanes yes, Lanes no) {
  return (mask & yes) | (~mask & no);
}

/// Lanes of 0 or -1 as bits, the first one lowest.
inline std::uint8_t bits_of_lanes(Lanes mask) {
#if defined(__SSE2__)
  using Words = short __attribute__((vector_size(16)));
  const auto words = reinterpret_cast<Words>(mask);
  return static_cast<std::uint8_t>(
      __builtin_ia32_pmovmskb128(__builtin_ia32_packsswb128(words, Words{})));
#else
  std::uint8_t bytes[kLanes];
  store_bytes(mask & all(1), bytes);
  return static_cast<std::uint8_t>((load64(bytes) * 0x0102040810204080u) >> 56);
#endif
}

}  // namespace rprr::dhcm
