// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rprr_eval/profile/profile.hpp"
#include "rprr_pose/pose_evidence.hpp"

namespace rprr {

/// What a search found for one synthetic pair, and whether it was right.
struct BeliefSample {
  PoseEvidence evidence;
  bool right = false;  // as in metrics.hpp; what is neither right nor wrong is no sample
};

/// Synthetic scenes (rooms, turntables and corridors in equal parts) to learn belief from.
struct BeliefOptions {
  int scenes = 45;
  std::uint32_t first_seed = 5001;
  int pairs_per_scene = 8;
  double max_degrees = 60.0;  // of the motions
  double max_metres = 1.2;
  int width = 640;  // [px]
};

/// Pairs of each scene, and as many of frames from two different scenes, all searched cold. Those
/// whose views share less than the profile accepts teach nothing and are left out.
std::vector<BeliefSample> belief_samples(const BeliefOptions& options, const Profile& profile);

/// log odds = constant + slopes . terms_of(evidence)
struct BeliefModel {
  std::array<double, kEvidenceTerms> slopes{};
  double constant = 0.0;

  double log_odds(const PoseEvidence& evidence) const;
};

/// Logistic regression by Newton's method, with a little shrinkage of the standardised slopes so
/// that samples that can be separated do not send them off.
BeliefModel fit_belief(const std::vector<BeliefSample>& samples);

/// Medians of the terms of right poses: what weaknesses of a pose are held against
/// (rprr_pose/pose_evidence.hpp). Zeros if no sample is right.
std::array<double, kEvidenceTerms> typical_terms(const std::vector<BeliefSample>& samples);

}  // namespace rprr
