// SPDX-License-Identifier: BSD-3-Clause
#include "../src/mixed_bit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rprr {
namespace {

TEST(MixedBit, SquashIsTheLogisticFunctionAndStretchItsInverse) {
  for (int d = -2047; d <= 2047; ++d) {
    const double exact = 65536.0 / (1.0 + std::exp(-d / 256.0));
    EXPECT_NEAR(mixed_bit::squash(d), exact, 400.0) << d;
    if (d > -2047) {
      EXPECT_GE(mixed_bit::squash(d), mixed_bit::squash(d - 1));
    }
  }
  EXPECT_EQ(mixed_bit::squash(-1000000), mixed_bit::squash(-2047));
  EXPECT_EQ(mixed_bit::squash(1000000), mixed_bit::squash(2047));
  EXPECT_GT(mixed_bit::squash(-2047), 0);
  EXPECT_LT(mixed_bit::squash(2047), 65536);
  for (int p = 200; p < 65336; p += 16) {
    const int d = mixed_bit::kStretch[static_cast<std::size_t>(p >> 4)];
    EXPECT_NEAR(mixed_bit::squash(d), p, 80) << p;
  }
}

TEST(MixedBit, AnEstimateApproachesTheShareOfOnes) {
  std::mt19937 random(1);
  BitEstimate estimate;
  EXPECT_EQ(estimate.one(), 32768);
  for (int i = 0; i < 2000; ++i) estimate.update(random() % 4 == 0);
  EXPECT_NEAR(estimate.one() / 65536.0, 0.25, 0.12);
  for (int i = 0; i < 5000; ++i) estimate.update(true);
  EXPECT_GT(estimate.one(), 65000);
  for (int i = 0; i < 5000; ++i) estimate.update(false);
  EXPECT_LT(estimate.one(), 500);
}

TEST(MixedBit, AMixerLearnsWhichContextKnows) {
  std::mt19937 random(2);
  BitMixer<2> mixer;
  std::array<BitEstimate, 2> knowing;  // by the bit that will come
  std::array<BitEstimate, 2> guessing;
  int wrong = 0;
  for (int i = 0; i < 3000; ++i) {
    const bool bit = random() % 2 == 0;
    const BitMixer<2>::Estimates at = {&knowing[bit ? 1 : 0], &guessing[random() % 2]};
    const int one = mixer.mix(at);
    if (i > 500 && (one > 32768) != bit) ++wrong;
    mixer.update(at, bit);
  }
  EXPECT_EQ(wrong, 0);
}

// What a hostile sender may do to it: nothing overflows, no probability is 0 or 1.
TEST(MixedBit, StaysWithinBoundsWhateverTheBits) {
  BitMixer<4> mixer;
  std::array<BitEstimate, 4> estimates;
  BitMixer<4>::Estimates at{};
  for (std::size_t i = 0; i < 4; ++i) at[i] = &estimates[i];
  for (int i = 0; i < 200000; ++i) {
    const int one = mixer.mix(at);
    ASSERT_GT(one, 0);
    ASSERT_LT(one, 65536);
    const bool unexpected = one < 32768;
    mixer.update(at, i % 5000 < 2500 ? unexpected : !unexpected);
  }
}

}  // namespace
}  // namespace rprr
