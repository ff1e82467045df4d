// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/correspondence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rprr {
namespace {

constexpr int kReach = 3;     // 7x7, paper
constexpr int kMaxSteps = 6;  // walks end; so far they would leave the surface anyway
constexpr double kNearest = 0.05;

struct Nearest {
  int u = -1;
  int v = -1;
  float distance2 = std::numeric_limits<float>::max();
};

Nearest nearest_around(const Eigen::Vector3f& point, const DepthFrame& target, const Camera& camera,
                       int u, int v) {
  Nearest best;
  const auto unit = static_cast<float>(target.unit);
  const auto per_fx = static_cast<float>(1.0 / camera.fx);
  const auto per_fy = static_cast<float>(1.0 / camera.fy);
  const int last_u = std::min(u + kReach, camera.width - 1);
  const int last_v = std::min(v + kReach, camera.height - 1);
  for (int row = std::max(v - kReach, 0); row <= last_v; ++row) {
    const auto* counts = target.counts.ptr<std::uint16_t>(row);
    const float y = (static_cast<float>(row) - static_cast<float>(camera.cy)) * per_fy;
    for (int column = std::max(u - kReach, 0); column <= last_u; ++column) {
      if (counts[column] == 0) continue;
      const float z = static_cast<float>(counts[column]) * unit;
      const float x = (static_cast<float>(column) - static_cast<float>(camera.cx)) * per_fx;
      const float dx = x * z - point.x();
      const float dy = y * z - point.y();
      const float dz = z - point.z();
      const float distance2 = dx * dx + dy * dy + dz * dz;
      if (distance2 < best.distance2) best = {column, row, distance2};
    }
  }
  return best;
}

}  // namespace

Correspondence project_and_walk(const Eigen::Vector3d& point, const DepthFrame& target,
                                const Camera& camera) {
  Correspondence found;
  if (point.z() < kNearest) return found;
  const Eigen::Vector2d pixel = camera.project(point);
  if (!camera.contains(pixel.x(), pixel.y())) return found;
  int u = std::min(static_cast<int>(std::floor(pixel.x() + 0.5)), camera.width - 1);
  int v = std::min(static_cast<int>(std::floor(pixel.y() + 0.5)), camera.height - 1);
  found.kind = Correspondence::Kind::kNoDepth;
  found.depth_at_projection = target.metres(u, v);

  const Eigen::Vector3f moved = point.cast<float>();
  Nearest best = nearest_around(moved, target, camera, u, v);
  if (best.u < 0) return found;
  for (int step = 1; step < kMaxSteps && (best.u != u || best.v != v); ++step) {
    u = best.u;
    v = best.v;
    best = nearest_around(moved, target, camera, u, v);
  }
  found.kind = Correspondence::Kind::kFound;
  found.u = best.u;
  found.v = best.v;
  found.point = camera.unproject(best.u, best.v, target.metres(best.u, best.v));
  return found;
}

}  // namespace rprr
