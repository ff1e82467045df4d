// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/turntable/turntable.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "rprr_eval/measure/median.hpp"
#include "rprr_geometry/relative_pose.hpp"

namespace rprr {
namespace {

// Sums over the trials of one method at one angle.
struct Tally {
  TurntablePoint point;
  std::vector<double> metres, degrees;

  void add(const RegistrationResult& result, const PoseError& error) {
    metres.push_back(error.metres);
    degrees.push_back(error.degrees);
    ++point.trials;
    point.solved += is_right(error) ? 1 : 0;
    point.converged += result.converged ? 1 : 0;
    point.accepted += result.accepted ? 1 : 0;
    point.mean_iterations += result.iterations;
    point.max_iterations = std::max(point.max_iterations, result.iterations);
  }
  TurntablePoint finish() {
    const auto rms = [](const std::vector<double>& values) {
      double sum = 0.0;
      for (const double value : values) sum += value * value;
      return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
    };
    point.rms_metres = rms(metres);
    point.rms_degrees = rms(degrees);
    point.median_metres = median(metres);
    point.median_degrees = median(degrees);
    if (point.trials > 0) point.mean_iterations /= point.trials;
    return point;
  }
};

}  // namespace

std::vector<TurntablePoint> run_turntable(
    const TurntableOptions& options, const std::vector<std::unique_ptr<Registration>>& methods) {
  std::vector<std::vector<Tally>> tallies(methods.size());
  for (int s = 0; s < options.seeds; ++s) {
    const TurntableViews views =
        render_turntable(options.first_seed + static_cast<std::uint32_t>(s), options);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      tallies[m].resize(views.frames.size() - 1);
      for (std::size_t k = 1; k < views.frames.size(); ++k) {
        Tally& tally = tallies[m][k - 1];
        tally.point.method = methods[m]->name();
        tally.point.degrees = views.degrees[k];
        const RegistrationResult result =
            methods[m]->align(*views.frames[0], *views.frames[k], Pose::Identity());
        const Pose truth = relative_pose_of(views.world_from_camera[0], views.world_from_camera[k]);
        tally.add(result, pose_error(result.b_from_a, truth));
      }
    }
  }
  std::vector<TurntablePoint> points;
  for (auto& of_method : tallies) {
    for (Tally& tally : of_method) points.push_back(tally.finish());
  }
  return points;
}

std::vector<TurntableLimit> turntable_limits(const std::vector<TurntablePoint>& points) {
  std::vector<TurntableLimit> limits;
  for (const TurntablePoint& point : points) {
    if (limits.empty() || limits.back().method != point.method) {
      limits.push_back({point.method, std::nullopt, std::nullopt});
    }
    TurntableLimit& limit = limits.back();
    if (!limit.first_miss && point.solved < point.trials) limit.first_miss = point.degrees;
    if (!limit.first_fails && 2 * point.solved < point.trials) limit.first_fails = point.degrees;
  }
  return limits;
}

}  // namespace rprr
