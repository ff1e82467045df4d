// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rprr::dhcm {

/// Numbers up to 65535 as a Huffman symbol and some plain bits: the first kDirect have a symbol of
/// their own; above, a symbol stands for a power of two and the bit below it, and the rest of the
/// bits follow as they are.
constexpr int kDirect = 16;
constexpr int kNumberSymbols = kDirect + 2 * 12;
/// No reading at this pixel.
constexpr int kHoleSymbol = kNumberSymbols;
constexpr int kSymbols = kNumberSymbols + 1;
/// The longest run that one number states; it says that the run goes on.
constexpr std::uint32_t kRunLimit = 65535;

inline int floor_log2(std::uint32_t value) {
  return 31 - __builtin_clz(value);
}

struct Split {
  std::uint8_t symbol;
  std::uint8_t extra_bits;
  std::uint16_t extra;
};

inline Split split_number(std::uint32_t number) {
  if (number < kDirect) return {static_cast<std::uint8_t>(number), 0, 0};
  const int power = floor_log2(number);  // 4..15
  const int extra_bits = power - 1;
  const std::uint32_t half = number >> extra_bits & 1u;
  return {static_cast<std::uint8_t>(kDirect + 2 * (power - 4) + static_cast<int>(half)),
          static_cast<std::uint8_t>(extra_bits),
          static_cast<std::uint16_t>(number & ((1u << extra_bits) - 1u))};
}

inline int extra_bits_of(int symbol) {
  return symbol < kDirect || symbol >= kNumberSymbols ? 0 : (symbol - kDirect) / 2 + 3;
}
/// The smallest number that a symbol stands for.
inline std::uint32_t base_of(int symbol) {
  if (symbol < kDirect) return static_cast<std::uint32_t>(symbol);
  const int power = (symbol - kDirect) / 2 + 4;
  return (1u << power) | static_cast<std::uint32_t>((symbol - kDirect) & 1) << (power - 1);
}

/// Residuals modulo 2^16 to numbers, small ones first whatever their sign: 0, 1, -1, 2, -2, ...
inline std::uint32_t fold(std::uint16_t residual) {
  const auto value = static_cast<std::int32_t>(static_cast<std::int16_t>(residual));
  return static_cast<std::uint32_t>(value > 0 ? 2 * value - 1 : -2 * value);
}
inline std::uint16_t unfold(std::uint32_t number) {
  const auto half = static_cast<std::int32_t>((number + 1) >> 1);
  return static_cast<std::uint16_t>((number & 1u) != 0 ? half : -half);
}

}  // namespace rprr::dhcm
