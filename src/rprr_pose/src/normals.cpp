// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/normals.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace rprr {
namespace {

constexpr int kReach = 4;           // pixels to each side
constexpr int kStride = 2;          // every second pixel
constexpr int kMinNeighbours = 10;  // of 25
constexpr double kEdge =
    0.04;  // relative depth step, a pixel's distance away, that is another surface

}  // namespace

std::optional<Eigen::Vector3d> normal_at(const DepthFrame& frame, const Camera& camera, int u,
                                         int v) {
  const double centre = frame.metres(u, v);
  if (centre <= 0.0) return std::nullopt;
  // q = alpha du + beta dv + gamma, in pixels around (u, v), for conditioning.
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int neighbours = 0;
  for (int dv = -kReach; dv <= kReach; dv += kStride) {
    if (v + dv < 0 || v + dv >= frame.height()) continue;
    const auto* row = frame.counts.ptr<std::uint16_t>(v + dv);
    for (int du = -kReach; du <= kReach; du += kStride) {
      if (u + du < 0 || u + du >= frame.width() || row[u + du] == 0) continue;
      const double z = row[u + du] * frame.unit;
      if (std::abs(z - centre) > kEdge * centre) continue;
      const Eigen::Vector3d basis(du, dv, 1.0);
      moments += basis * basis.transpose();
      right += basis / z;
      ++neighbours;
    }
  }
  if (neighbours < kMinNeighbours) return std::nullopt;
  const Eigen::LDLT<Eigen::Matrix3d> factors(moments);
  if (factors.info() != Eigen::Success || factors.rcond() < 1e-6) return std::nullopt;
  const Eigen::Vector3d plane = factors.solve(right);
  // n . p = d with p = z (x, y, 1) gives q = (n / d) . (x, y, 1).
  const double alpha = plane[0] * camera.fx;
  const double beta = plane[1] * camera.fy;
  const double x = (u - camera.cx) / camera.fx;
  const double y = (v - camera.cy) / camera.fy;
  Eigen::Vector3d normal(alpha, beta, plane[2] - alpha * x - beta * y);
  const double length = normal.norm();
  if (!(length > 1e-9) || plane[2] <= 0.0) return std::nullopt;
  normal /= length;
  return normal.dot(Eigen::Vector3d(x, y, 1.0)) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace rprr
