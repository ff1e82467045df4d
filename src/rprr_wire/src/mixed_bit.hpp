// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace rprr {

/// Probabilities of bits where there are too few bits to learn from in any one context: several
/// contexts each make an estimate, and a mixer that learns whom to trust weighs them in the
/// logistic domain, as the PAQ family of coders does. Whole numbers only, so that the two ends of a
/// radio agree whatever their processors.

namespace mixed_bit {

constexpr int kLimit = 2047;  // of the logistic domain, in 1/256: ln(p / (1 - p)) up to 8

/// 65536 / (1 + exp(-d / 256)), linear between 33 points.
constexpr std::array<int, 33> kLogistic = {
    24,    36,    60,    98,    162,   267,   439,   720,   1179,  1921,  3108,
    4971,  7812,  11955, 17625, 24743, 32768, 40793, 47911, 53581, 57724, 60565,
    62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65512};

/// By d + 2048, d from -2048 to 2047.
constexpr std::array<std::uint16_t, 4096> squash_table() {
  std::array<std::uint16_t, 4096> table{};
  for (std::size_t i = 0; i < 4096; ++i) {
    const int fraction = static_cast<int>(i % 128);
    const int sum = kLogistic[i / 128] * (128 - fraction) + kLogistic[i / 128 + 1] * fraction;
    table[i] = static_cast<std::uint16_t>(sum / 128);
  }
  return table;
}
constexpr std::array<std::uint16_t, 4096> kSquash = squash_table();

constexpr int squash(int d) {
  return kSquash[static_cast<std::size_t>((d < -kLimit  ? -kLimit
                                           : d > kLimit ? kLimit
                                                        : d) +
                                          2048)];
}

/// The inverse of squash, by the probability's upper 12 bits.
constexpr std::array<std::int16_t, 4096> stretch_table() {
  std::array<std::int16_t, 4096> table{};
  int d = -kLimit;
  for (int i = 0; i < 4096; ++i) {
    while (d < kLimit && squash(d) < 16 * i + 8) ++d;
    table[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(d);
  }
  return table;
}
constexpr std::array<std::int16_t, 4096> kStretch = stretch_table();

/// 65536 / (n + 1.9): how far the n-th bit of a context moves its estimate.
constexpr std::array<int, 41> kRates = {
    34493, 22599, 16804, 13375, 11108, 9498, 8296, 7364, 6620, 6012, 5507, 5080, 4715, 4398,
    4122,  3878,  3661,  3468,  3293,  3136, 2993, 2862, 2742, 2632, 2530, 2436, 2349, 2268,
    2192,  2121,  2054,  1992,  1933,  1878, 1826, 1776, 1729, 1685, 1643, 1602, 1564};

}  // namespace mixed_bit

/// How likely the next bit of a context is a one.
class BitEstimate {
 public:
  /// Out of 65536.
  int one() const { return one_; }
  int stretched() const { return mixed_bit::kStretch[static_cast<std::size_t>(one_ >> 4)]; }
  void update(bool bit) {
    const int target = bit ? 65535 : 0;
    one_ = static_cast<std::uint16_t>(one_ + ((target - one_) * mixed_bit::kRates[seen_] >> 16));
    if (seen_ + 1u < mixed_bit::kRates.size()) ++seen_;
  }

 private:
  std::uint16_t one_ = 32768;
  std::uint16_t seen_ = 0;
};

template <std::size_t N>
class BitMixer {
 public:
  using Estimates = std::array<BitEstimate*, N>;

  BitMixer() { weights_.fill(20000); }

  /// The probability of a one, times 65536; never 0 or 65536.
  int mix(const Estimates& estimates) {
    int sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
      inputs_[i] = estimates[i]->stretched();
      sum += inputs_[i] * weights_[i];
    }
    mixed_ = mixed_bit::squash(sum >> 16);
    return mixed_;
  }
  /// After mix(): the bit that it was.
  void update(const Estimates& estimates, bool bit) {
    const int error = ((bit ? 65535 : 0) - mixed_) >> 4;
    for (std::size_t i = 0; i < N; ++i) {
      weights_[i] = std::clamp(weights_[i] + (inputs_[i] * error >> 10), -kMost, kMost);
      estimates[i]->update(bit);
    }
  }

 private:
  static constexpr int kMost = 1 << 17;  // N times kMost times kLimit stays within 31 bits
  static_assert(N <= 8, "sums would overflow");

  std::array<int, N> weights_;  // 65536 is one
  std::array<int, N> inputs_{};
  int mixed_ = 32768;
};

}  // namespace rprr
