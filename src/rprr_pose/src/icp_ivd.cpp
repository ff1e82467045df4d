// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "rprr_pose/correspondence.hpp"
#include "rprr_pose/icp_bd.hpp"
#include "rprr_pose/normals.hpp"
#include "rprr_pose/registration.hpp"
#include "rprr_pose/sampling.hpp"

namespace rprr {
namespace {

constexpr double kSmallestScale = 1e-4;  // 1/m: with perfect data the weights must not become 0/0

using Jacobian = Eigen::Matrix<double, 3, 6>;

Eigen::Vector3d inverse_depth(const Eigen::Vector3d& p) {
  return Eigen::Vector3d(p.x(), p.y(), 1.0) / p.z();
}

// The paper's J: how (u, v, q) of a point moves with the motion vector (its generators' order).
Jacobian jacobian(const Eigen::Vector3d& uvq) {
  const double u = uvq.x();
  const double v = uvq.y();
  const double q = uvq.z();
  Jacobian j;
  j << q, 0, -u * q, -u * v, 1 + u * u, -v,  //
      0, q, -v * q, -1 - v * v, v * u, u,    //
      0, 0, -q * q, -v * q, u * q, 0;
  return j;
}

// A plane n . p = d is n . (u, v, 1) = d q, so (n_x, n_y, -d) stands on it in (u, v, q).
Eigen::Vector3d normal_in_inverse_depth(const Eigen::Vector3d& normal,
                                        const Eigen::Vector3d& point) {
  return Eigen::Vector3d(normal.x(), normal.y(), -normal.dot(point)).normalized();
}

struct Row {
  Twist gradient;
  double residual;
};

std::vector<Row> rows_at(const std::vector<SamplePoint>& samples, const RgbdFrame& a,
                         const RgbdFrame& b, const Pose& b_from_a) {
  std::vector<Row> rows;
  rows.reserve(samples.size());
  for (const SamplePoint& sample : samples) {
    const Eigen::Vector3d moved =
        b_from_a * a.camera.unproject(sample.column, sample.row, sample.counts * a.depth.unit);
    const Correspondence found = project_and_walk(moved, b.depth, b.camera);
    if (found.kind != Correspondence::Kind::kFound) continue;
    const auto normal = normal_at(b.depth, b.camera, found.u, found.v);
    if (!normal) continue;
    const Eigen::Vector3d uvq = inverse_depth(moved);
    const Eigen::Vector3d across = normal_in_inverse_depth(*normal, found.point);
    rows.push_back(
        {jacobian(uvq).transpose() * across, -(uvq - inverse_depth(found.point)).dot(across)});
  }
  return rows;
}

// Weighted sums; c is the mean of the absolute residuals.
NormalEquations sums_of(const std::vector<Row>& rows) {
  NormalEquations sums;
  double c = 0.0;
  for (const Row& row : rows) c += std::abs(row.residual);
  c = std::max(c / static_cast<double>(std::max<std::size_t>(rows.size(), 1)), kSmallestScale);
  for (const Row& row : rows) {
    const double weight = c / (c + std::abs(row.residual));
    sums.ktwk += weight * row.gradient * row.gradient.transpose();
    sums.ktwy += weight * row.residual * row.gradient;
    sums.sum_residual2 += weight * row.residual * row.residual;
    sums.sum_weight += weight;
    ++sums.matched;
  }
  return sums;
}

class IcpIvd final : public Registration {
 public:
  explicit IcpIvd(const IterationLimits& limits) : limits_(limits) {}

  std::string name() const override { return "icp_ivd"; }

  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    RegistrationResult result;
    result.b_from_a = start;
    const auto samples = sample_points(a.depth, a.camera, kSampleCount, 1);
    while (result.iterations < limits_.max_iterations && !result.converged) {
      const NormalEquations sums = sums_of(rows_at(samples, a, b, result.b_from_a));
      Twist step;
      if (!solve(sums, step)) return result;
      ++result.iterations;
      result.residual = std::sqrt(sums.sum_residual2 / sums.sum_weight);
      result.b_from_a = exp_se3(step) * result.b_from_a;
      result.converged = limits_.reached_by(step);
    }
    result.accepted = result.converged;
    return result;
  }

 private:
  const IterationLimits limits_;
};

}  // namespace

std::unique_ptr<Registration> make_icp_ivd(const IterationLimits& limits) {
  return std::make_unique<IcpIvd>(limits);
}

}  // namespace rprr
