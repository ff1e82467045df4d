// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

/// What a registration of two frames led to.
struct RegistrationResult {
  Pose b_from_a = Pose::Identity();  // the paper's M_ab: p_b = b_from_a p_a
  bool converged = false;            // by the method's own stopping rule
  bool accepted = false;             // the method vouches for it; without a verification: converged
  int iterations = 0;
  double residual = 0.0;  // RMS at the last iteration, metres unless the method says otherwise
  std::size_t bytes = 0;  // exchanged by radio; 0 where both whole frames are taken for granted
};

/// A pose method that sees both frames in one process: the baselines of the paper, and whatever is
/// to be compared with them. Calls do not depend on each other unless a method says so.
class Registration {
 public:
  virtual ~Registration() = default;
  virtual std::string name() const = 0;
  /// `start` is a first estimate of M_ab; methods that search on their own may ignore it. Frames
  /// must be of their cameras' sizes. Too little depth is no error, but no convergence.
  virtual RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) = 0;
};

/// When an iterative method stops. The thresholds of Lui et al. are not public; these are ours.
struct IterationLimits {
  int max_iterations = 50;              // paper
  double converged_translation = 1e-3;  // [m]
  double converged_rotation = 1e-3;     // [rad]

  bool reached_by(const Twist& step) const {
    return step.head<3>().norm() < converged_translation &&
           step.tail<3>().norm() < converged_rotation;
  }
};

/// Standard point-to-point ICP (Besl and McKay, PAMI 1992): 250 points of a, their true nearest
/// neighbours in b's whole cloud (a k-d tree over every second row and column), the closed-form
/// motion between them, no rejection and no weights. It converges linearly, so by default it stops
/// later than the others.
std::unique_ptr<Registration> make_icp(const IterationLimits& limits = {200, 2e-4, 2e-4});

/// ICP in inverse depth coordinates (Lui et al., ICRA 2012): 250 points of a matched in Z_b by
/// project-and-walk, point-to-plane in (u, v, q) = (x/z, y/z, 1/z) with normals in that space, the
/// Jacobian that the paper prints, symmetric robust weights; one direction only. The residual is in
/// 1/metres.
std::unique_ptr<Registration> make_icp_ivd(const IterationLimits& limits = {});

/// The paper's ICP-BD as it stands: 250 points of each robot, new ones in every iteration, the
/// asymmetric weights alone. New points move the pose by about 1e-3, hence the wider thresholds.
std::unique_ptr<Registration> make_icp_bd(const IterationLimits& limits = {50, 3e-3, 3e-3});

}  // namespace rprr
