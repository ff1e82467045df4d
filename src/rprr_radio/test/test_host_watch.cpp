// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio_ros/host_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace rprr {
namespace {

using Step = HostWatch::Step;

// A host whose bytes and answers come at given instants, watched four times a second.
struct Watched {
  std::function<bool(double)> talks;      // by the second: bytes come
  std::function<bool(double)> reachable;  // a probe sent now is answered
  double answer_seconds = 0.05;

  std::vector<double> probes{};
  std::vector<double> renewals{};
  HostWatch watch{};

  void run(double seconds) {
    double heard = 0.0;
    double answer_at = std::numeric_limits<double>::infinity();
    for (double t = 0.0; t < seconds; t += 0.25) {
      if (talks(t)) heard = t;
      const bool answered = t >= answer_at;
      if (answered) answer_at = std::numeric_limits<double>::infinity();
      const Step step = watch.step(t - heard, answered, steady_seconds(100.0 + t));
      if (step == Step::kProbe) {
        probes.push_back(t);
        if (reachable(t)) answer_at = std::min(answer_at, t + answer_seconds);
      }
      if (step == Step::kRenew) renewals.push_back(t);
    }
  }
};

bool always(double) {
  return true;
}
std::function<bool(double)> except(double from, double to) {
  return [=](double t) { return t < from || t >= to; };
}

TEST(HostWatch, AHostThatTalksIsLeftAlone) {
  Watched host{always, always};
  host.run(60.0);
  EXPECT_TRUE(host.probes.empty());
  EXPECT_TRUE(host.renewals.empty());
}

TEST(HostWatch, AfterASilenceConnectionsAreRenewedOnceAndSoon) {
  for (const double outage : {4.0, 5.0, 10.0, 30.0, 120.0}) {
    const double back = 10.0 + outage;
    // TCP is stuck for as long again.
    Watched host{except(10.0, back + outage), except(10.0, back)};
    host.run(back + outage);
    ASSERT_EQ(host.renewals.size(), 1U) << "silent for " << outage << " s";
    EXPECT_GE(host.renewals[0], back);
    EXPECT_LE(host.renewals[0], back + 1.5) << "silent for " << outage << " s";
  }
}

TEST(HostWatch, WhatComesByItselfIsNotRenewed) {
  Watched host{except(10.0, 20.25), except(10.0, 20.0)};
  host.run(40.0);
  EXPECT_FALSE(host.probes.empty());
  EXPECT_TRUE(host.renewals.empty());
}

TEST(HostWatch, AHostWithNothingToSayIsRarelyAskedAndNeverRenewed) {
  Watched host{except(10.0, 1000.0), always};
  host.run(110.0);
  EXPECT_TRUE(host.renewals.empty());
  EXPECT_GE(host.probes.size(), 10U);
  EXPECT_LE(host.probes.size(), 25U) << "probes are bytes on the radio";
}

TEST(HostWatch, ASilenceWhileThereWasNothingToSayIsFound) {
  Watched host{except(10.0, 1000.0), except(50.0, 60.0)};
  host.run(80.0);
  ASSERT_EQ(host.renewals.size(), 1U);
  EXPECT_LE(host.renewals[0], 61.5);
}

TEST(HostWatch, EveryOutageIsOneRenewal) {
  const auto place = [](double t) { return std::fmod(t, 30.0); };
  Watched host{[=](double t) { return place(t) > 3.0 && place(t) < 20.0; },
               [=](double t) { return place(t) < 20.0; }};
  host.run(150.0);
  EXPECT_EQ(host.renewals.size(), 4U);
}

TEST(HostWatch, ANarrowRadioIsNotTakenForASilentOne) {
  // A full queue: bytes come every few seconds, and answers take as long as anything.
  Watched host{[](double t) { return std::fmod(t, 5.0) < 0.25; }, always, 2.0};
  host.run(120.0);
  EXPECT_LE(host.renewals.size(), 1U) << "until it knows the radio";
  host.renewals.clear();
  host.run(120.0);
  EXPECT_TRUE(host.renewals.empty());
  // Really silent, it is found out all the same.
  host.reachable = except(10.0, 40.0);
  host.talks = [](double t) { return t < 10.0; };
  host.run(60.0);
  EXPECT_EQ(host.renewals.size(), 1U);
}

TEST(HostWatch, SaysForHowLongNothingWasAnswered) {
  Watched host{except(10.0, 1000.0), except(10.0, 1000.0)};
  host.run(11.0);
  EXPECT_EQ(host.watch.unanswered_for(steady_seconds(111.0)), 0.0);
  host.run(30.0);
  EXPECT_GT(host.watch.unanswered_for(steady_seconds(130.0)), 15.0);
}

}  // namespace
}  // namespace rprr
