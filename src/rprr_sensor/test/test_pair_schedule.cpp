// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/recordings/pair_schedule.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

using Pair = std::pair<std::size_t, std::size_t>;

TEST(PairSchedule, EveryPairOnce) {
  PairSchedule schedule(4, {1, 0, 0, false});
  EXPECT_EQ(schedule.pairs(), 3u);
  EXPECT_EQ(schedule.next(), Pair(0, 1));
  EXPECT_EQ(schedule.next(), Pair(1, 2));
  EXPECT_EQ(schedule.next(), Pair(2, 3));
  EXPECT_EQ(schedule.next(), std::nullopt);
  EXPECT_EQ(schedule.next(), std::nullopt);
}

TEST(PairSchedule, StartStepCountAndLoop) {
  PairSchedule schedule(10, {3, 2, 2, true});
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(schedule.next(), Pair(2, 5));
    EXPECT_EQ(schedule.next(), Pair(3, 6));
  }
}

TEST(PairSchedule, TooFewEntriesGiveNoPairs) {
  for (const bool loop : {false, true}) {
    EXPECT_EQ(PairSchedule(0, {1, 0, 0, loop}).next(), std::nullopt);
    EXPECT_EQ(PairSchedule(3, {3, 0, 0, loop}).next(), std::nullopt);
    EXPECT_EQ(PairSchedule(3, {1, 2, 0, loop}).next(), std::nullopt);
    EXPECT_EQ(PairSchedule(3, {1, ~std::size_t{0}, 1, loop}).next(), std::nullopt);
  }
}

TEST(PairSchedule, CountIsLimitedByTheRecording) {
  EXPECT_EQ(PairSchedule(5, {1, 1, 100, false}).pairs(), 3u);
}

}  // namespace
}  // namespace rprr
