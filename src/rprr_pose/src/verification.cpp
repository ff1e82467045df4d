// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/verification.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "pose_check.hpp"
#include "rprr_pose/icp_bd.hpp"

namespace rprr {
namespace {

double share(std::uint32_t part, std::uint32_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

double worst_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues().maxCoeff()));
}

PoseCheck overlap_check(const NormalEquations& both, const VerificationLimits& limits) {
  return {PoseStatus::kLittleOverlap, PoseQuantity::kOverlap, share(both.in_view, both.points),
          limits.min_overlap};
}

// The overlap was tested before: points are in view, and too few of them have a counterpart.
PoseCheck matches_check(const NormalEquations& both, const VerificationLimits& limits) {
  return {PoseStatus::kTooFewPoints, PoseQuantity::kMatchedPoints,
          static_cast<double>(static_cast<int>(both.matched)),
          static_cast<double>(limits.min_matched)};
}

std::array<PoseCheck, 2> direction_checks(const NormalEquations& both,
                                          const VerificationLimits& limits) {
  const Matrix6 covariance = covariance_of(both);
  return {{{PoseStatus::kFreeDirection, PoseQuantity::kTranslationSigma,
            worst_sigma(covariance.topLeftCorner<3, 3>()), limits.max_sigma_translation},
           {PoseStatus::kFreeDirection, PoseQuantity::kRotationSigma,
            worst_sigma(covariance.bottomRightCorner<3, 3>()), limits.max_sigma_rotation}}};
}

// Chooses the check whose figure is nearest to its limit. A check without a ratio (0 of 0) is
// passed over; the first one stands if all are.
const PoseCheck& nearest_to_failing(const std::array<PoseCheck, 7>& checks) {
  const PoseCheck* nearest = &checks.front();
  double most = 0.0;
  for (const PoseCheck& check : checks) {
    if (!(check.use_of_limit() > most)) continue;
    most = check.use_of_limit();
    nearest = &check;
  }
  return *nearest;
}

}  // namespace

PoseVerdict verify(const NormalEquations& at_dependent, const NormalEquations& at_reference,
                   const VerificationLimits& limits) {
  NormalEquations both = at_dependent;
  both += at_reference;
  const double violating = std::max(share(at_dependent.violating, at_dependent.in_view),
                                    share(at_reference.violating, at_reference.in_view));
  const std::array<PoseCheck, 2> directions = direction_checks(both, limits);
  const std::array<PoseCheck, 7> checks = {{
      overlap_check(both, limits),
      matches_check(both, limits),
      {PoseStatus::kFreeSpaceViolated, PoseQuantity::kFreeSpace, violating, limits.max_violating},
      {PoseStatus::kDepthDisagrees, PoseQuantity::kConsistent, share(both.consistent, both.in_view),
       limits.min_consistent},
      {PoseStatus::kDepthDisagrees, PoseQuantity::kResidual,
       std::sqrt(both.sum_normalised2 / both.matched), limits.max_residual_sigmas},
      directions[0],
      directions[1],
  }};
  const PoseCheck* failed = first_failed(checks);
  return failed ? failed->rejected() : nearest_to_failing(checks).accepted();
}

std::optional<PoseVerdict> why_unsolved(const NormalEquations& both,
                                        const VerificationLimits& limits) {
  const std::array<PoseCheck, 2> directions = direction_checks(both, limits);
  const std::array<PoseCheck, 4> checks = {
      {overlap_check(both, limits), matches_check(both, limits), directions[0], directions[1]}};
  const PoseCheck* failed = first_failed(checks);
  return failed ? std::optional(failed->rejected()) : std::nullopt;
}

}  // namespace rprr
