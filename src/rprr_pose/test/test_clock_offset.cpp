// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/clock_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace rprr {
namespace {

constexpr SteadyTime kStart = steady_seconds(100.0);

TEST(ClockOffset, IsWithinItsUncertaintyHoweverTheWaysDiffer) {
  std::mt19937 random(1);
  std::uniform_real_distribution<> way(0.002, 0.3);
  for (const double truth : {0.0, 0.015, -0.2, 3600.0}) {
    ClockOffset clock;
    for (int i = 0; i < 20; ++i) clock.add(way(random) + truth, way(random) - truth, kStart + i);
    const auto estimate = clock.estimate(kStart + 100);
    ASSERT_TRUE(estimate);
    EXPECT_LE(std::abs(estimate->offset - truth), estimate->uncertainty + 1e-9) << truth;
    EXPECT_LT(estimate->uncertainty, 0.15) << "the shortest way counts";
  }
}

TEST(ClockOffset, NonsenseIsIgnored) {
  ClockOffset clock;
  clock.add(-1.0, 0.5, kStart);
  clock.add(std::numeric_limits<double>::quiet_NaN(), 0.1, kStart);
  clock.add(std::numeric_limits<double>::infinity(), 0.1, kStart);
  clock.add(1e12, -1e12 + 0.1, kStart);
  EXPECT_FALSE(clock.estimate(kStart));
}

TEST(ClockOffset, FollowsAClockThatIsSet) {
  ClockOffset clock;
  clock.add(0.001, 0.001, kStart);
  const SteadyTime later = kStart + from_seconds(61.0);
  clock.add(5.05, -4.95, later);
  const auto estimate = clock.estimate(later);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->offset, 5.0, 1e-9);
  EXPECT_FALSE(clock.estimate(later + from_seconds(61.0))) << "what is old is forgotten";
}

TEST(ClockOffset, AClockThatIsSetIsNoticedWithTheNextExchange) {
  ClockOffset clock;
  for (int i = 0; i < 20; ++i) clock.add(0.001, 0.001, kStart + i);
  clock.add(5.2, -4.8, kStart + 100);
  const auto estimate = clock.estimate(kStart + 100);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->offset, 5.0, 1e-9);
  clock.add(0.011, -0.001, kStart + 200);
  clock.add(0.013, -0.001, kStart + 300);
  ASSERT_TRUE(clock.estimate(kStart + 300));
  EXPECT_NEAR(clock.estimate(kStart + 300)->offset, 0.006, 1e-9)
      << "a forged answer is outdone as well";
}

TEST(ClockOffset, ALongWayContradictsNothing) {
  ClockOffset clock;
  clock.add(0.101, -0.099, kStart);
  clock.add(3.1, 0.5, kStart + 1);
  ASSERT_TRUE(clock.estimate(kStart + 1));
  EXPECT_NEAR(clock.estimate(kStart + 1)->offset, 0.1, 1e-9);
}

}  // namespace
}  // namespace rprr
