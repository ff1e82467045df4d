// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_evidence.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

Agreement agreeing() {
  Agreement way;
  way.valid = 3000;
  way.in_view = 2000;
  way.consistent = 1900;
  way.violating = 10;
  way.hidden = 60;
  way.correlation = 0.9;
  way.fine_correlation = 0.5;
  return way;
}

TEST(PoseEvidence, IsTheWorseOfBothWays) {
  Agreement worse = agreeing();
  worse.consistent = 1700;
  worse.violating = 100;
  worse.correlation = 0.8;
  const PoseEvidence evidence = evidence_of(agreeing(), worse, 0.4);
  EXPECT_DOUBLE_EQ(evidence.correlation, 0.8);
  EXPECT_DOUBLE_EQ(evidence.fine_correlation, 0.5);
  EXPECT_NEAR(evidence.outliers, 140.0 / 2000.0, 1e-12);
  EXPECT_NEAR(evidence.violating, 0.05, 1e-12);
  const PoseEvidence swapped = evidence_of(worse, agreeing(), 0.4);
  EXPECT_EQ(terms_of(swapped), terms_of(evidence));
}

TEST(PoseEvidence, EveryTermMovesBeliefItsWay) {
  const PoseEvidence good = evidence_of(agreeing(), agreeing(), 0.2);
  EXPECT_GT(log_odds(good), 2.0);
  const auto with = [&good](auto change) {
    PoseEvidence changed = good;
    change(changed);
    return log_odds(changed);
  };
  EXPECT_LT(with([](PoseEvidence& e) { e.correlation = 0.6; }), log_odds(good));
  EXPECT_LT(with([](PoseEvidence& e) { e.fine_correlation = 0.1; }), log_odds(good));
  EXPECT_LT(with([](PoseEvidence& e) { e.outliers = 0.2; }), log_odds(good));
  EXPECT_LT(with([](PoseEvidence& e) { e.violating = 0.08; }), log_odds(good));
  EXPECT_LT(with([](PoseEvidence& e) { e.margin = 0.0; }), log_odds(good));
}

TEST(PoseEvidence, TheWeakestTermIsTheCause) {
  const PoseEvidence good = evidence_of(agreeing(), agreeing(), 0.3);
  const auto cause = [&good](auto change) {
    PoseEvidence changed = good;
    change(changed);
    return weakest_evidence(changed);
  };
  EXPECT_EQ(cause([](PoseEvidence& e) { e.correlation = -0.5; }), PoseStatus::kColourDisagrees);
  EXPECT_EQ(cause([](PoseEvidence& e) { e.fine_correlation = 0.0; }), PoseStatus::kColourDisagrees);
  EXPECT_EQ(cause([](PoseEvidence& e) { e.outliers = 0.3; }), PoseStatus::kDepthDisagrees);
  EXPECT_EQ(cause([](PoseEvidence& e) { e.violating = 0.1; }), PoseStatus::kFreeSpaceViolated);
  EXPECT_EQ(cause([](PoseEvidence& e) { e.margin = 0.0; }), PoseStatus::kAmbiguous);
}

TEST(PoseEvidence, NothingSharedIsNotBelieved) {
  EXPECT_LT(log_odds(evidence_of({}, {}, 1.0)), 0.0);
}

TEST(PoseEvidence, PerfectCorrelationIsFinite) {
  Agreement perfect = agreeing();
  perfect.correlation = perfect.fine_correlation = 1.0;
  EXPECT_LT(log_odds(evidence_of(perfect, perfect, 1.0)), 20.0);
}

}  // namespace
}  // namespace rprr
