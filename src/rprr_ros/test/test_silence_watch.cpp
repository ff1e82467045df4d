// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rprr_ros/silence_watch.hpp"

namespace rprr {
namespace {

SteadyTime at(double seconds) {
  return steady_seconds(seconds);
}

TEST(SilenceWatch, WhoNeverSpokeIsNotMissed) {
  EXPECT_FALSE(SilenceWatch().silent_for("b", at(100.0)));
}

TEST(SilenceWatch, AFastRobotIsMissedAfterSomeSecondsUntilItSpeaksAgain) {
  SilenceWatch watch;
  for (int i = 0; i < 50; ++i) watch.heard("b", at(0.2 * i));
  const double last = 0.2 * 49;
  EXPECT_FALSE(watch.silent_for("b", at(last + 2.9)));
  ASSERT_TRUE(watch.silent_for("b", at(last + 3.1)));
  EXPECT_NEAR(*watch.silent_for("b", at(last + 60.0)), 60.0, 1e-6);
  watch.heard("b", at(last + 60.0));
  EXPECT_FALSE(watch.silent_for("b", at(last + 61.0)));
  EXPECT_TRUE(watch.silent_for("b", at(last + 63.1))) << "the gap did not make it patient";
}

TEST(SilenceWatch, ASlowRobotIsGivenItsTime) {
  SilenceWatch watch;
  for (int i = 0; i < 50; ++i) watch.heard("b", at(5.0 * i));
  const double last = 5.0 * 49;
  EXPECT_FALSE(watch.silent_for("b", at(last + 10.0)));
  EXPECT_TRUE(watch.silent_for("b", at(last + 21.0)));
}

TEST(SilenceWatch, AfterASingleMessageNobodyKnowsHowOftenTheyCome) {
  SilenceWatch watch;
  watch.heard("b", at(0.0));
  EXPECT_FALSE(watch.silent_for("b", at(8.9)));
  EXPECT_TRUE(watch.silent_for("b", at(9.1)));
}

TEST(SilenceWatch, RobotsAreWatchedApart) {
  SilenceWatch watch;
  for (const double since : {0.0, 0.5}) {
    watch.heard("a", at(since));
    watch.heard("b", at(5.0 + since));
  }
  EXPECT_TRUE(watch.silent_for("a", at(6.0)));
  EXPECT_FALSE(watch.silent_for("b", at(6.0)));
}

}  // namespace
}  // namespace rprr
