// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "rprr_geometry/se3.hpp"

namespace rprr {

/// One robot's half of the normal equations of paper eq. 6, K^T W K b = K^T W y, over its
/// correspondences, and what verification needs to know about them.
struct NormalEquations {
  Matrix6 ktwk = Matrix6::Zero();  // sum of w J^T J
  Twist ktwy = Twist::Zero();      // sum of w J^T y
  double sum_residual2 = 0.0;      // sum of w y^2, m^2
  double sum_weight = 0.0;
  double sum_normalised2 = 0.0;  // sum of y^2 over the variance that the sensor's noise gives it
  double sum_abs_dz = 0.0;       // sum |z_a - z_b|, metres, both in b's frame
  std::uint32_t points = 0;      // points asked about
  std::uint32_t in_view = 0;     // of those, inside the other image, on or near valid depth
  std::uint32_t matched = 0;     // of those, correspondences that entered the sums
  std::uint32_t consistent = 0;  // of in_view: same depth within noise where the point projects
  std::uint32_t violating = 0;  // of in_view: in free space, clearly before what the other measured

  NormalEquations& operator+=(const NormalEquations& other);
  /// One correspondence: the point of a moved into b's frame, b's point, b's normal, weight, and
  /// the variance of its residual due to noise, m^2. Residual and Jacobian are taken at the moved
  /// point; all normals are b's (the printed y_a, y_b and J of the paper are not consistent with
  /// each other: see docs/profiles.md).
  void add(const Eigen::Vector3d& moved_a, const Eigen::Vector3d& b,
           const Eigen::Vector3d& normal_b, double weight, double variance);
};

}  // namespace rprr
