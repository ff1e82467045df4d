// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/belief/belief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rprr_pose/preview_pose.hpp"

namespace rprr {
namespace {

// Samples whose odds are known.
std::vector<BeliefSample> drawn(const BeliefModel& model, int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<BeliefSample> samples;
  for (int i = 0; i < count; ++i) {
    BeliefSample sample;
    sample.evidence.correlation = 0.95 * unit(random);
    sample.evidence.fine_correlation = 0.8 * unit(random);
    sample.evidence.outliers = 0.3 * unit(random);
    sample.evidence.violating = 0.1 * unit(random);
    sample.evidence.margin = 0.3 * unit(random);
    sample.right = unit(random) < 1.0 / (1.0 + std::exp(-model.log_odds(sample.evidence)));
    samples.push_back(sample);
  }
  return samples;
}

TEST(Belief, TheFitFindsTheOddsThatSamplesWereDrawnWith) {
  const BeliefModel truth{{2.0, 4.0, -8.0, -20.0, 6.0}, -2.0};
  const BeliefModel found = fit_belief(drawn(truth, 20000));
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    EXPECT_NEAR(found.slopes[i], truth.slopes[i], 0.15 * std::abs(truth.slopes[i]) + 0.1) << i;
  }
  PoseEvidence middle;
  middle.correlation = 0.5;
  middle.fine_correlation = 0.4;
  middle.outliers = 0.15;
  middle.violating = 0.05;
  middle.margin = 0.15;
  EXPECT_NEAR(found.log_odds(middle), truth.log_odds(middle), 0.15);
}

TEST(Belief, SamplesThatCanBeSeparatedDoNotSendTheSlopesOff) {
  std::vector<BeliefSample> samples(40);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].right = i % 2 == 0;
    samples[i].evidence.correlation = samples[i].right ? 0.9 : 0.1;
  }
  const BeliefModel model = fit_belief(samples);
  EXPECT_GT(model.slopes[0], 0.0);
  EXPECT_LT(model.slopes[0], 100.0);
  EXPECT_EQ(fit_belief({}).constant, 0.0);
}

TEST(Belief, TypicalTermsAreMediansOfRightPosesAlone) {
  std::vector<BeliefSample> samples(9);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].right = i < 5;
    samples[i].evidence.margin = samples[i].right ? 0.02 * static_cast<double>(i) : 0.3;
  }
  samples[0].evidence.margin = 0.25;  // one is far off
  EXPECT_DOUBLE_EQ(typical_terms(samples)[4], 0.06);
  EXPECT_EQ(typical_terms({})[4], 0.0);
}

TEST(Belief, SearchesOfSmallScenesGiveSamplesOfBothKinds) {
  BeliefOptions options;
  options.scenes = 3;
  options.pairs_per_scene = 3;
  options.max_degrees = 15.0;
  options.max_metres = 0.2;
  options.width = 320;
  const std::vector<BeliefSample> samples = belief_samples(options, *load_profile("default"));
  int right = 0;
  for (const BeliefSample& sample : samples) right += sample.right ? 1 : 0;
  EXPECT_GE(right, 5) << "of 9 pairs close together";
  for (const BeliefSample& sample : samples) {
    if (sample.right) continue;
    EXPECT_LT(log_odds(sample.evidence), PreviewLimits().min_evidence) << "a wrong one is believed";
  }
}

}  // namespace
}  // namespace rprr
