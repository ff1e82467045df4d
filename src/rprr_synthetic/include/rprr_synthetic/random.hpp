// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rprr {

/// Mixes 64 bits well (splitmix64's finaliser): random numbers that depend on nothing but their
/// place, the same with every standard library.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Mean 0, deviation 1, within +-3.47: the sum of four uniform 16-bit numbers.
inline float nearly_gaussian(std::uint64_t bits) {
  const auto sum = static_cast<float>((bits & 0xffff) + ((bits >> 16) & 0xffff) +
                                      ((bits >> 32) & 0xffff) + (bits >> 48));
  return (sum - 131070.0f) * (1.7320508f / 65536.0f);
}

/// A sequence of random numbers from a seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mix_bits(seed)) {}

  std::uint64_t bits() { return mix_bits(state_++); }
  /// In [0, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// In [0, count).
  int below(int count) { return static_cast<int>(unit() * count); }

 private:
  std::uint64_t state_;
};

}  // namespace rprr
