// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/verification.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

}  // namespace

PoseStatus verify(const NormalEquations& at_dependent, const NormalEquations& at_reference,
                  const VerificationLimits& limits) {
  NormalEquations both = at_dependent;
  both += at_reference;
  if (share(both.in_view, both.points) < limits.min_overlap) return PoseStatus::kLittleOverlap;
  if (static_cast<int>(both.matched) < limits.min_matched) return PoseStatus::kLittleOverlap;
  const double violating = std::max(share(at_dependent.violating, at_dependent.in_view),
                                    share(at_reference.violating, at_reference.in_view));
  if (violating > limits.max_violating) return PoseStatus::kFreeSpaceViolated;
  if (share(both.consistent, both.in_view) < limits.min_consistent)
    return PoseStatus::kInconsistent;
  const double sigmas = std::sqrt(both.sum_normalised2 / both.matched);
  if (sigmas > limits.max_residual_sigmas) return PoseStatus::kInconsistent;
  const Matrix6 covariance = covariance_of(both);
  if (worst_sigma(covariance.topLeftCorner<3, 3>()) > limits.max_sigma_translation ||
      worst_sigma(covariance.bottomRightCorner<3, 3>()) > limits.max_sigma_rotation) {
    return PoseStatus::kDegenerate;
  }
  return PoseStatus::kAccepted;
}

}  // namespace rprr
