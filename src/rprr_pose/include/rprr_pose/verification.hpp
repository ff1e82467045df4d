// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rprr_pose/normal_equations.hpp"
#include "rprr_pose/pose_verdict.hpp"

namespace rprr {

/// When a pose of protocol `samples` is accepted. A wrong pose is worse than no saving.
struct VerificationLimits {
  double min_overlap = 0.25;     // share of sampled points that fall into the other's view
  double min_consistent = 0.75;  // share of the points in view whose depths agree within noise
  double max_violating = 0.08;   // share of the points in view that lie in seen free space
  double max_residual_sigmas =
      3.0;               // RMS of the residuals, in units of what the sensor's noise makes
  int min_matched = 60;  // correspondences, both ways together
  double max_sigma_translation = 0.01;  // in the worst direction [m]; tight, since the covariance
                                        // takes the correspondences for granted
  double max_sigma_rotation = 0.007;    // about the worst axis [rad]
};

/// Judges the final pose by both halves, each one-way: a scene that hides in one direction shows in
/// the other. The worse half decides on violations. A rejection carries the first test that failed,
/// an acceptance the test that came nearest to failing (as a share of its limit).
PoseVerdict verify(const NormalEquations& at_dependent, const NormalEquations& at_reference,
                   const VerificationLimits& limits);

/// Tells why the sums of an iteration, both halves together, gave no usable step. It is nothing if
/// the sums are in order, so that the step itself was too long, and never an acceptance.
std::optional<PoseVerdict> why_unsolved(const NormalEquations& both,
                                        const VerificationLimits& limits);

}  // namespace rprr
