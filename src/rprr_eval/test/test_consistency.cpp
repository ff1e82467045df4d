// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/consistency/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "rprr_synthetic/random.hpp"

namespace rprr {
namespace {

Matrix6 some_covariance() {
  Matrix6 root = Matrix6::Identity();
  root(1, 0) = 0.5;
  root(3, 1) = -0.7;
  root(5, 2) = 0.3;
  root.topRows<3>() *= 0.004;
  root.bottomRows<3>() *= 0.001;
  return root * root.transpose();
}

// Trials whose errors are drawn from `scale` times the covariance that they state.
std::vector<PoseTrial> drawn_trials(int count, double scale, const Twist& bias = Twist::Zero()) {
  Random random(5);
  const Matrix6 covariance = some_covariance();
  const Matrix6 root = covariance.llt().matrixL();
  std::vector<PoseTrial> trials;
  for (int k = 0; k < count; ++k) {
    Twist normal;
    for (int i = 0; i < 6; ++i) normal[i] = static_cast<double>(nearly_gaussian(random.bits()));
    PoseTrial trial;
    trial.verdict.status = PoseStatus::kAccepted;
    trial.perturbation = std::sqrt(scale) * (root * normal) + bias;
    trial.covariance = covariance;
    trials.push_back(trial);
  }
  return trials;
}

TEST(Consistency, ErrorsOfTheStatedSizeAreConsistent) {
  const ConsistencySummary summary = summarise(drawn_trials(400, 1.0));
  EXPECT_TRUE(summary.all.consistent()) << summary.all.mean;
  EXPECT_TRUE(summary.translation.consistent()) << summary.translation.mean;
  EXPECT_TRUE(summary.rotation.consistent()) << summary.rotation.mean;
  EXPECT_NEAR(summary.all.share_within_95, 0.95, 0.03);
  EXPECT_NEAR(summary.all.scale_by_median, 1.0, 0.15);
  EXPECT_LT(summary.mean.cwiseAbs().maxCoeff(), 0.15);
  EXPECT_NEAR(summary.rms.mean(), 1.0, 0.05);
}

TEST(Consistency, TheScaleSaysWhatTheCovarianceLacks) {
  for (const double scale : {0.25, 4.0}) {
    const ConsistencySummary summary = summarise(drawn_trials(400, scale));
    EXPECT_FALSE(summary.all.consistent());
    EXPECT_NEAR(summary.all.scale_by_mean / scale, 1.0, 0.1);
    EXPECT_NEAR(summary.all.scale_by_median / scale, 1.0, 0.15);
    EXPECT_NEAR(summary.rms.mean() / std::sqrt(scale), 1.0, 0.05);
  }
}

TEST(Consistency, ABiasShowsOnItsAxis) {
  Twist bias = Twist::Zero();
  bias[2] = 2.0 * std::sqrt(some_covariance()(2, 2));
  const ConsistencySummary summary = summarise(drawn_trials(400, 1.0, bias));
  EXPECT_NEAR(summary.mean[2], 2.0, 0.15);
  EXPECT_NEAR(summary.mean[4], 0.0, 0.15);
  EXPECT_FALSE(summary.translation.consistent());
  EXPECT_TRUE(summary.rotation.consistent());
}

TEST(Consistency, OnlyAcceptedPosesCount) {
  std::vector<PoseTrial> trials = drawn_trials(10, 1.0);
  trials[3].verdict.status = PoseStatus::kFreeDirection;
  trials[3].perturbation.setConstant(1.0);
  trials[3].error = {1.0, 90.0};
  trials[4].error = {0.5, 0.0};
  const ConsistencySummary summary = summarise(trials);
  EXPECT_EQ(summary.pairs, 10);
  EXPECT_EQ(summary.accepted, 9);
  EXPECT_EQ(summary.accepted_right, 8);
  EXPECT_EQ(summary.accepted_wrong, 1);
  EXPECT_LT(summary.all.mean, 60.0);
  EXPECT_EQ(summarise({}).accepted, 0);
}

TEST(Consistency, ACovarianceThatIsNoneIsNeverConsistent) {
  PoseTrial trial;
  trial.perturbation.setConstant(1e-3);
  EXPECT_TRUE(std::isinf(normalised_error(trial)));
  EXPECT_TRUE(std::isinf(normalised_error_of_half(trial, 3)));
}

TEST(ConsistencyPairs, AreTheSameForTheSameSeedAndWithinTheLimits) {
  ConsistencyOptions options;
  options.pairs_per_scene = 2;
  options.width = 160;
  const auto first = consistency_pairs(7, options);
  const auto again = consistency_pairs(7, options);
  ASSERT_EQ(first.size(), 2u);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_TRUE(first[i].truth.isApprox(again[i].truth));
    EXPECT_EQ(cv::countNonZero(first[i].b->depth.counts != again[i].b->depth.counts), 0);
    EXPECT_LE(rotation_angle(first[i].truth.linear()), 15.0 * M_PI / 180.0 + 1e-9);
    EXPECT_LE(first[i].truth.translation().norm(), 2.0);
    EXPECT_LE(first[i].truth.inverse().translation().norm(), 0.3 + 1e-9);
    EXPECT_NE(first[i].a->camera.fx, first[i].b->camera.fx) << "two sensors";
  }
  EXPECT_FALSE(first[0].truth.isApprox(first[1].truth));
}

TEST(ConsistencyPairs, EverySceneHasDepthForBoth) {
  ConsistencyOptions options;
  options.pairs_per_scene = 1;
  options.width = 160;
  for (const TrueScene scene : {TrueScene::kRoom, TrueScene::kTurntable, TrueScene::kCorridor}) {
    options.scene = scene;
    const TruePair pair = consistency_pairs(7, options).front();
    EXPECT_GT(cv::countNonZero(pair.a->depth.counts), 160 * 120 / 10);
    EXPECT_GT(cv::countNonZero(pair.b->depth.counts), 160 * 120 / 10);
  }
}

// The perturbation has to be M_est's from the left, as the covariance is stated.
TEST(ConsistencyPairs, AnExchangeIsHeldAgainstTheTruth) {
  ConsistencyOptions options;
  options.pairs_per_scene = 1;
  options.width = 320;
  options.max_degrees = 5.0;
  options.max_metres = 0.1;
  const auto pairs = consistency_pairs(3, options);
  const Result<Profile> profile = load_profile("default");
  ASSERT_TRUE(profile) << profile.reason();
  const PoseTrial trial = try_pair(pairs.front(), *profile);
  EXPECT_TRUE(trial.accepted()) << describe(trial.verdict);
  EXPECT_TRUE(is_right(trial.error)) << trial.error.metres << " m";
  EXPECT_GT(trial.overlap, 0.5);
  EXPECT_NEAR(trial.perturbation.tail<3>().norm() * 180.0 / M_PI, trial.error.degrees, 1e-6);
  EXPECT_GT(normalised_error(trial), 0.0);
}

}  // namespace
}  // namespace rprr
