// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio/rate_limit.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <utility>

namespace rprr {
namespace {

constexpr double kRate = 10000.0;
constexpr SteadyTime kStart = steady_seconds(1000.0);

TEST(RateLimit, ABurstIsThereAtOnceAndNoMore) {
  RateLimit limit(kRate);
  EXPECT_TRUE(limit.has_room(static_cast<std::size_t>(limit.burst()), kStart));
  EXPECT_FALSE(limit.has_room(static_cast<std::size_t>(limit.burst()) + 1, kStart));
  EXPECT_FALSE(
      limit.has_room(static_cast<std::size_t>(limit.burst()) + 1, kStart + from_seconds(60.0)))
      << "a pause saves nothing up";
}

TEST(RateLimit, ThereIsRoomWhenItSaysSoAndNotBefore) {
  RateLimit limit(kRate);
  limit.spend(5000, kStart);
  const SteadyTime at = limit.room_at(1000, kStart);
  EXPECT_GT(at, kStart);
  EXPECT_FALSE(limit.has_room(1000, at - from_seconds(0.001)));
  EXPECT_TRUE(limit.has_room(1000, at));
}

TEST(RateLimit, AClockThatGoesBackDoesNoHarm) {
  RateLimit limit(kRate);
  limit.spend(static_cast<std::size_t>(limit.burst()), kStart);
  EXPECT_FALSE(limit.has_room(1000, kStart - from_seconds(100.0)));
  EXPECT_TRUE(limit.has_room(1000, kStart + from_seconds(0.2)));
}

TEST(RateLimit, NoTwoSecondsTakeMoreThanTheirShareHoweverItIsAsked) {
  std::mt19937 random(7);
  RateLimit limit(kRate);
  std::deque<std::pair<SteadyTime, std::size_t>> window;
  std::size_t in_window = 0;
  std::size_t total = 0;
  SteadyTime now = kStart;
  for (int i = 0; i < 20000; ++i) {
    now += from_seconds(std::uniform_real_distribution<>(0.0, 0.02)(random));
    if (random() % 500 == 0) now += from_seconds(1.5);
    const std::size_t bytes = 1 + random() % 1500;
    while (!window.empty() && window.front().first <= now - from_seconds(2.0)) {
      in_window -= window.front().second;
      window.pop_front();
    }
    if (!limit.has_room(bytes, now)) continue;
    limit.spend(bytes, now);
    window.emplace_back(now, bytes);
    in_window += bytes;
    total += bytes;
    ASSERT_LE(static_cast<double>(in_window), 2.0 * kRate);
  }
  EXPECT_GT(static_cast<double>(total), 0.6 * kRate * to_seconds(now - kStart)) << "and it is used";
}

}  // namespace
}  // namespace rprr
