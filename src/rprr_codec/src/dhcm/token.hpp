// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace rprr::dhcm {

/// Numbers below 2^26 as a Huffman symbol and some plain bits: the first kDirect have a symbol of
/// their own; above, a symbol stands for a power of two and the bit below it, and the rest of the
/// bits follow as they are.
constexpr int kDirect = 16;
constexpr int kSymbols = kDirect + 2 * 22;
/// Symbols of residuals, which are below 2^16, and the one after them: no reading at this pixel.
constexpr int kResidualSymbols = kDirect + 2 * 12;
constexpr int kHoleSymbol = kResidualSymbols;
/// The longest run: that of the largest image.
constexpr std::uint32_t kRunLimit = (1u << 26) - 1;

inline int floor_log2(std::uint32_t value) {
  return 31 - __builtin_clz(value);
}

struct Split {
  std::uint8_t symbol;
  std::uint8_t extra_bits;
  std::uint32_t extra;
};

inline Split split_number(std::uint32_t number) {
  if (number < kDirect) return {static_cast<std::uint8_t>(number), 0, 0};
  const int power = floor_log2(number);  // 4..25
  const int extra_bits = power - 1;
  const std::uint32_t half = number >> extra_bits & 1u;
  return {static_cast<std::uint8_t>(kDirect + 2 * (power - 4) + static_cast<int>(half)),
          static_cast<std::uint8_t>(extra_bits), number & ((1u << extra_bits) - 1u)};
}

inline int extra_bits_of(int symbol) {
  return symbol < kDirect ? 0 : (symbol - kDirect) / 2 + 3;
}
/// The smallest number that a symbol stands for.
inline std::uint32_t base_of(int symbol) {
  if (symbol < kDirect) return static_cast<std::uint32_t>(symbol);
  const int power = (symbol - kDirect) / 2 + 4;
  return (1u << power) | static_cast<std::uint32_t>((symbol - kDirect) & 1) << (power - 1);
}

/// Residuals modulo 2^16 to numbers, small ones first whatever their sign: 0, 1, -1, 2, -2, ... up
/// to 65535, which stands for -32768: 65536 would need a symbol more.
inline std::uint32_t fold(std::uint16_t residual) {
  const auto value = static_cast<std::int32_t>(static_cast<std::int16_t>(residual));
  return static_cast<std::uint32_t>(value > 0 ? 2 * value - 1 : std::min(-2 * value, 65535));
}
inline std::uint16_t unfold(std::uint32_t number) {
  const auto half = static_cast<std::int32_t>((number + 1) >> 1);
  return static_cast<std::uint16_t>((number & 1u) != 0 ? half : -half);
}

}  // namespace rprr::dhcm
