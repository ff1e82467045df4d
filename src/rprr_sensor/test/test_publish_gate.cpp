// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/publish_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rprr {
namespace {

constexpr Stamp kStart = from_seconds(1.7e9);

/// How many of ten seconds' frames pass.
int passed(PublishGate& gate, double rate, double jitter = 0.0) {
  int count = 0;
  for (int k = 0; k < static_cast<int>(10 * rate); ++k) {
    const double shake = jitter * ((k * 7) % 3 - 1);
    count += gate.pass(kStart + from_seconds(k / rate + shake)) ? 1 : 0;
  }
  return count;
}

TEST(PublishGate, EverythingPassesByDefault) {
  PublishGate gate;
  EXPECT_EQ(passed(gate, 30.0), 300);
}

TEST(PublishGate, EveryNthBeginningWithTheFirst) {
  PublishGate gate;
  gate.limit(7, 0.0);
  EXPECT_TRUE(gate.pass(kStart));
  EXPECT_EQ(passed(gate, 30.0), 300 / 7);
}

TEST(PublishGate, MaxRateHoldsAndIsReached) {
  for (const double rate : {1.0, 5.0, 10.0, 15.0, 24.0, 30.0}) {
    PublishGate gate;
    gate.limit(1, rate);
    const int count = passed(gate, 30.0, 0.002);
    EXPECT_LE(count, 10 * rate + 1) << rate;
    EXPECT_GE(count, 0.95 * 10 * rate) << rate;
  }
}

TEST(PublishGate, RobotsChooseFramesOfTheSameMoments) {
  for (const double rate : {1.0, 2.0, 5.0, 7.0}) {
    for (double phase = 0.0; phase < 0.033; phase += 0.004) {
      PublishGate a, b;
      a.limit(1, rate);
      b.limit(1, rate);
      std::vector<Stamp> of_a, of_b;
      for (int k = 0; k < 300; ++k) {
        const Stamp stamp = kStart + from_seconds(k / 30.0);
        if (a.pass(stamp)) of_a.push_back(stamp);
        if (b.pass(stamp + from_seconds(phase))) of_b.push_back(stamp + from_seconds(phase));
      }
      // Either may have one of a period more at the beginning.
      while (of_a.size() > of_b.size()) of_a.erase(of_a.begin());
      while (of_b.size() > of_a.size()) of_b.erase(of_b.begin());
      for (std::size_t k = 1; k < of_a.size(); ++k) {
        EXPECT_LT(std::abs(to_seconds(of_a[k] - of_b[k])), 0.034) << rate << " " << phase;
      }
    }
  }
}

TEST(PublishGate, PausedItGivesOneFrameForEachTrigger) {
  PublishGate gate;
  EXPECT_FALSE(gate.trigger()) << "not paused";
  gate.pause(true);
  EXPECT_EQ(passed(gate, 30.0), 0);
  EXPECT_TRUE(gate.trigger());
  EXPECT_TRUE(gate.trigger());
  EXPECT_EQ(passed(gate, 30.0), 2);
  gate.trigger();
  gate.pause(false);
  gate.pause(true);
  EXPECT_EQ(passed(gate, 30.0), 0) << "a trigger does not outlive its pause";
  gate.pause(false);
  EXPECT_EQ(passed(gate, 30.0), 300);
}

TEST(PublishGate, StampsThatJumpBackDoNotSilenceIt) {
  PublishGate gate;
  gate.limit(1, 1.0);
  EXPECT_TRUE(gate.pass(kStart));
  EXPECT_TRUE(gate.pass(kStart - from_seconds(1000.0)));
  EXPECT_FALSE(gate.pass(kStart - from_seconds(999.5)));
}

}  // namespace
}  // namespace rprr
