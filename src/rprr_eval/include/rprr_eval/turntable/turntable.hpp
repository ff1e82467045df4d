// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rprr_eval/measure/metrics.hpp"
#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_pose/registration.hpp"
#include "rprr_synthetic/synthetic_scene.hpp"

namespace rprr {

/// The paper's turntable experiment, synthetic: objects on a table that turns before a Kinect on a
/// tripod; the background is excluded, that is, beyond the table there is no depth.
struct TurntableOptions {
  int seeds = 20;  // tables, each with other objects
  std::uint32_t first_seed = 1;
  double step_degrees = 5.0;
  double last_degrees = 60.0;
  int width = 640;  // [px]; the height is 3/4 of the width
};

/// A table of 0.35 m radius with its top at z = 0 of the world, and boxes, cylinders and spheres of
/// 6 to 30 cm on it that hide each other.
Scene make_turntable(std::uint32_t seed);

/// Camera 1.1 m from the middle of the table, 30 degrees above it, as seen from a table that has
/// turned by so much: world_from_camera.
Pose turntable_camera(double degrees);

/// One table seen at the angles 0, step, .. last; noise is that of the sensor model.
struct TurntableViews {
  std::vector<double> degrees;
  std::vector<RgbdFramePtr> frames;
  std::vector<Pose> world_from_camera;
};
TurntableViews render_turntable(std::uint32_t seed, const TurntableOptions& options);

/// One method at one angle over all tables.
struct TurntablePoint {
  std::string method;
  double degrees = 0.0;
  int trials = 0;
  int solved = 0;     // right in the sense of metrics.hpp
  int converged = 0;  // by the method's own word
  int accepted = 0;
  double rms_metres = 0.0, rms_degrees = 0.0;        // over all trials
  double median_metres = 0.0, median_degrees = 0.0;  // over all trials
  double mean_iterations = 0.0;                      // over all trials
  int max_iterations = 0;
};

/// Every method from the identity at every angle; ordered by method, then by angle.
std::vector<TurntablePoint> run_turntable(
    const TurntableOptions& options, const std::vector<std::unique_ptr<Registration>>& methods);

/// Where a method ends.
struct TurntableLimit {
  std::string method;
  std::optional<double> first_miss;   // smallest angle at which a table is not solved
  std::optional<double> first_fails;  // smallest angle at which less than half of them are
};
std::vector<TurntableLimit> turntable_limits(const std::vector<TurntablePoint>& points);

}  // namespace rprr
