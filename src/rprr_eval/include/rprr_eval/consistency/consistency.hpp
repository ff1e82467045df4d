// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "rprr_eval/measure/metrics.hpp"
#include "rprr_eval/profile/profile.hpp"
#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_pose/pose_verdict.hpp"

namespace rprr {

/// Where the pairs are: a furnished room, a turntable with nothing round it, or a corridor, along
/// which depth tells nothing.
enum class TrueScene { kRoom, kTurntable, kCorridor };

/// Synthetic pairs to hold a protocol's poses and covariances against exact truth: two different
/// sensors in scenes that nothing was tuned on.
struct ConsistencyOptions {
  TrueScene scene = TrueScene::kRoom;
  int seeds = 50;  // scenes
  std::uint32_t first_seed = 1001;
  int pairs_per_scene = 4;
  double max_degrees = 15.0;  // of the motion, about any axis
  double max_metres = 0.3;    // of the motion, in any direction
  int width = 640;            // [px]; the height is 3/4 of the width
};

/// Two frames with exact truth.
struct TruePair {
  RgbdFramePtr a, b;
  Pose truth = Pose::Identity();  // M_ab
};

/// The pairs of one scene; the same for the same seed and options.
std::vector<TruePair> consistency_pairs(std::uint32_t seed, const ConsistencyOptions& options);

/// What an exchange made of a pair.
struct PoseTrial {
  std::uint32_t seed = 0;  // of the scene
  int number = 0;          // of the pair in it
  double overlap = 0.0;
  double true_degrees = 0.0, true_metres = 0.0;  // of the motion
  PoseVerdict verdict;
  PoseError error;
  Twist perturbation = Twist::Zero();    // log(M_est M_true^-1): tx ty tz rx ry rz
  Matrix6 covariance = Matrix6::Zero();  // of the error, as the protocol states it

  bool accepted() const { return verdict.accepted(); }
};

/// The first exchange of two robots that have not met, with the profile's protocol.
PoseTrial try_pair(const TruePair& pair, const Profile& profile);

/// e^T P^-1 e, and the same for translation and rotation by themselves (first: 0 or 3). Infinite
/// where the covariance is not positive definite.
double normalised_error(const PoseTrial& trial);
double normalised_error_of_half(const PoseTrial& trial, int first);

/// Normalised errors against the chi-square distribution that they follow if the covariances say
/// how large the errors are.
struct NormalisedErrors {
  int freedom = 0;  // degrees of freedom of one error
  double mean = 0.0;
  double mean_from = 0.0, mean_to = 0.0;  // two-sided 95% bounds of a consistent mean
  double median = 0.0;
  double share_within_95 = 0.0;  // of the errors under the 95% quantile
  /// What the covariances would have to be multiplied by: from the mean (large if a few errors are
  /// far too large), and from the median.
  double scale_by_mean = 0.0, scale_by_median = 0.0;

  bool consistent() const { return mean >= mean_from && mean <= mean_to; }
};
NormalisedErrors normalised_errors(const std::vector<double>& errors, int freedom);

/// All of a run.
struct ConsistencySummary {
  int pairs = 0;
  int accepted = 0;
  int accepted_right = 0;  // right and wrong as in metrics.hpp
  int accepted_wrong = 0;
  // Over accepted pairs:
  double median_metres = 0.0, median_degrees = 0.0;
  double p95_metres = 0.0, p95_degrees = 0.0;
  NormalisedErrors all, translation, rotation;
  Twist mean = Twist::Zero();  // of each component over its own sigma: 0 without a bias
  Twist rms = Twist::Zero();   // of each component over its own sigma: 1 if the sigmas are right
};
ConsistencySummary summarise(const std::vector<PoseTrial>& trials);

}  // namespace rprr
