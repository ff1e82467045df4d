// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_pose/normal_equations.hpp"
#include "rprr_pose/sampling.hpp"

namespace rprr {

/// How correspondences are weighed.
struct IcpWeights {
  /// The c of the paper's weighting function: mean |z_a - z_b| of the previous iteration, metres; 0
  /// in the first: each side then takes the mean of its own correspondences.
  double c = 0.0;
  /// Also divide by the variance that depth noise causes along the normal, and leave out what is
  /// further off than a few of c (profile default). The paper weighs by c alone.
  bool by_noise = true;
};

/// Points of one robot in metres and its own frame.
struct SampledSurface {
  Camera camera;        // of the robot that sampled
  double unit = 0.001;  // metres per count
  std::vector<SamplePoint> points;
};

/// b's half: a's points matched in Z_b (first sum of paper eq. 2), normals from Z_b.
NormalEquations half_at_dependent(const SampledSurface& a_points, const DepthFrame& b_depth,
                                  const Camera& b_camera, const Pose& b_from_a,
                                  const IcpWeights& weights);

/// a's half: b's points, with b's normals, matched in Z_a (second sum of paper eq. 2, with the
/// residual (M_ab p*_{k,a} - p_{k,b}) . n_{k,b} that the paper's own K_a and y_a imply).
NormalEquations half_at_reference(const SampledSurface& b_points, const DepthFrame& a_depth,
                                  const Camera& a_camera, const Pose& b_from_a,
                                  const IcpWeights& weights);

/// Motion vector b of paper eq. 6. False if the system cannot be solved.
bool solve(const NormalEquations& equations, Twist& step);

/// Covariance of the left perturbation (tx ty tz rx ry rz) of M_ab from the sums at the solution:
/// the residuals' variance, not below what the sensor's noise makes it, times (K^T W K)^-1.
Matrix6 covariance_of(const NormalEquations& equations);

}  // namespace rprr
