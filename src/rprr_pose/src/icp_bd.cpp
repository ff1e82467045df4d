// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/icp_bd.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "rprr_pose/correspondence.hpp"
#include "rprr_pose/normals.hpp"

namespace rprr {
namespace {

// Floor of c, metres: with perfect data the weights must not become 0/0.
constexpr double kSmallestC = 1e-3;
// Correspondences this many times c apart carry no information about a smooth surface (by_noise).
constexpr double kGate = 4.0;
constexpr double kGateFloor = 0.03;  // [m]

// Two depths of one surface seen from two places: the tolerance that defines overlap.
double depth_tolerance(double z) {
  return 0.02 + 0.015 * z;
}

// One correspondence, everything in b's frame.
struct Match {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  Eigen::Vector3d normal;
};

// The paper's weighting function: asymmetric in which surface lies before the other.
double paper_weight(double z_a, double z_b, double c) {
  const double d = z_a - z_b;
  return z_b <= z_a ? c / (c + d) : c / (c + d * d);
}

// Variance of the residual along the normal due to both sensors' depth noise, and the floor that
// pixels and calibration add.
double residual_variance(const Match& match) {
  const double facing = match.normal.dot(match.b) / match.b.norm();
  const double along = depth_sigma(match.b.z()) * facing;
  return 2.0 * along * along + 2e-3 * 2e-3;
}

void accumulate(const std::vector<Match>& matches, const IcpWeights& weights,
                NormalEquations& out) {
  for (const Match& match : matches) out.sum_abs_dz += std::abs(match.a.z() - match.b.z());
  double c = weights.c;
  if (c <= 0.0 && !matches.empty()) c = out.sum_abs_dz / static_cast<double>(matches.size());
  c = std::max(c, kSmallestC);
  for (const Match& match : matches) {
    const double variance = residual_variance(match);
    double weight = paper_weight(match.a.z(), match.b.z(), c);
    if (weights.by_noise) {
      if ((match.a - match.b).norm() > std::max(kGate * c, kGateFloor)) continue;
      weight *= 4e-6 / variance;
    }
    out.add(match.a, match.b, match.normal, weight, variance);
  }
}

// Counts for verification: does the point agree with what the other camera measured there?
void judge(double z, const Correspondence& found, double distance, NormalEquations& out) {
  ++out.in_view;
  const double tolerance = depth_tolerance(z);
  const bool agrees =
      found.depth_at_projection > 0.0 && std::abs(z - found.depth_at_projection) < tolerance;
  if (agrees || distance < 0.5 * tolerance) {
    ++out.consistent;
  } else if (found.depth_at_projection > z + 2.0 * tolerance && distance > 2.0 * tolerance) {
    ++out.violating;
  }
}

}  // namespace

NormalEquations half_at_dependent(const SampledSurface& a_points, const DepthFrame& b_depth,
                                  const Camera& b_camera, const Pose& b_from_a,
                                  const IcpWeights& weights) {
  NormalEquations out;
  std::vector<Match> matches;
  matches.reserve(a_points.points.size());
  for (const SamplePoint& sample : a_points.points) {
    ++out.points;
    const Eigen::Vector3d moved =
        b_from_a *
        a_points.camera.unproject(sample.column, sample.row, sample.counts * a_points.unit);
    const Correspondence found = project_and_walk(moved, b_depth, b_camera);
    if (found.kind != Correspondence::Kind::kFound) continue;
    judge(moved.z(), found, (moved - found.point).norm(), out);
    const auto normal = normal_at(b_depth, b_camera, found.u, found.v);
    if (normal) matches.push_back({moved, found.point, *normal});
  }
  accumulate(matches, weights, out);
  return out;
}

NormalEquations half_at_reference(const SampledSurface& b_points, const DepthFrame& a_depth,
                                  const Camera& a_camera, const Pose& b_from_a,
                                  const IcpWeights& weights) {
  NormalEquations out;
  std::vector<Match> matches;
  matches.reserve(b_points.points.size());
  const Pose a_from_b = b_from_a.inverse();
  for (const SamplePoint& sample : b_points.points) {
    ++out.points;
    const Eigen::Vector3d point_b =
        b_points.camera.unproject(sample.column, sample.row, sample.counts * b_points.unit);
    const Eigen::Vector3d in_a = a_from_b * point_b;
    const Correspondence found = project_and_walk(in_a, a_depth, a_camera);
    if (found.kind != Correspondence::Kind::kFound) continue;
    judge(in_a.z(), found, (in_a - found.point).norm(), out);
    if (!sample.normal.isZero()) {
      matches.push_back({b_from_a * found.point, point_b, sample.normal.cast<double>()});
    }
  }
  accumulate(matches, weights, out);
  return out;
}

bool solve(const NormalEquations& equations, Twist& step) {
  if (equations.matched < 6) return false;
  const Eigen::LDLT<Matrix6> factors(equations.ktwk);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return false;
  step = factors.solve(equations.ktwy);
  return step.allFinite() && step.head<3>().norm() < 10.0 && step.tail<3>().norm() < M_PI;
}

Matrix6 covariance_of(const NormalEquations& equations) {
  // A weight of 1 stands for a residual of 2 mm (see accumulate): no fit is believed beyond that.
  constexpr double kLeastVariance = 4e-6;
  const double freedom = std::max(1.0, static_cast<double>(equations.matched) - 6.0);
  const double share = equations.sum_weight > 0.0
                           ? static_cast<double>(equations.matched) / equations.sum_weight
                           : 1.0;
  const double variance = std::max(equations.sum_residual2 * share / freedom, kLeastVariance);
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(equations.ktwk * share);
  // A direction without information has an unbounded variance; a large number says so as well.
  const Twist values = eigen.eigenvalues().cwiseMax(variance * 1e-2);
  return variance * eigen.eigenvectors() * values.cwiseInverse().asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace rprr
