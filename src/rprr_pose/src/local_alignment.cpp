// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/local_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rprr {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kCoarseIterations = 8;
constexpr int kFineIterations = 6;
constexpr std::size_t kRefined = 3;
constexpr std::size_t kPart = 3;  // every third point while there are many starts

// Rotations about the camera: between two robots that see the same thing most of what ICP cannot
// bridge is rotation.
std::vector<Pose> starting_poses() {
  std::vector<Pose> starts;
  for (const double yaw : {0.0, -10.0, 10.0, -20.0, 20.0}) {
    for (const double pitch : {0.0, -10.0, 10.0}) {
      Pose start = Pose::Identity();
      start.rotate(Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitY()));
      start.rotate(Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitX()));
      starts.push_back(start);
    }
  }
  return starts;
}

LocalAlignment iterate(const SampledSurface& b_points, const DepthFrame& a_depth,
                       const Camera& a_camera, const Pose& start, int iterations) {
  LocalAlignment result{start, 0.0};
  IcpWeights weights;
  for (int i = 0; i <= iterations; ++i) {
    const NormalEquations half =
        half_at_reference(b_points, a_depth, a_camera, result.b_from_a, weights);
    if (half.points == 0) return result;
    result.score = (half.consistent - 2.0 * half.violating) / half.points;
    Twist step;
    if (i == iterations || !solve(half, step)) return result;
    result.b_from_a = exp_se3(step) * result.b_from_a;
    weights.c = half.sum_abs_dz / half.matched;
  }
  return result;
}

SampledSurface part_of(const SampledSurface& surface) {
  SampledSurface part{surface.camera, surface.unit, {}};
  for (std::size_t i = 0; i < surface.points.size(); i += kPart) {
    part.points.push_back(surface.points[i]);
  }
  return part;
}

bool better(const LocalAlignment& left, const LocalAlignment& right) {
  return left.score > right.score;
}

}  // namespace

LocalAlignment align_locally(const SampledSurface& b_points, const DepthFrame& a_depth,
                             const Camera& a_camera) {
  const SampledSurface part = part_of(b_points);
  std::vector<LocalAlignment> candidates;
  for (const Pose& start : starting_poses()) {
    candidates.push_back(iterate(part, a_depth, a_camera, start, kCoarseIterations));
  }
  std::stable_sort(candidates.begin(), candidates.end(), better);
  candidates.resize(std::min(candidates.size(), kRefined));
  for (LocalAlignment& candidate : candidates) {
    candidate = iterate(b_points, a_depth, a_camera, candidate.b_from_a, kFineIterations);
  }
  return *std::min_element(candidates.begin(), candidates.end(), better);
}

}  // namespace rprr
