// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/normal_equations.hpp"

namespace rprr {

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  ktwk += other.ktwk;
  ktwy += other.ktwy;
  sum_residual2 += other.sum_residual2;
  sum_weight += other.sum_weight;
  sum_normalised2 += other.sum_normalised2;
  sum_abs_dz += other.sum_abs_dz;
  points += other.points;
  in_view += other.in_view;
  matched += other.matched;
  consistent += other.consistent;
  violating += other.violating;
  return *this;
}

void NormalEquations::add(const Eigen::Vector3d& moved_a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& normal_b, double weight, double variance) {
  // d(exp(x) p)/dx at x = 0 is [I | -[p]x], so n^T times it is [n^T | (p x n)^T].
  Twist row;
  row.head<3>() = normal_b;
  row.tail<3>() = moved_a.cross(normal_b);
  const double y = -(moved_a - b).dot(normal_b);
  ktwk += weight * row * row.transpose();
  ktwy += weight * y * row;
  sum_residual2 += weight * y * y;
  sum_weight += weight;
  sum_normalised2 += y * y / variance;
  ++matched;
}

}  // namespace rprr
