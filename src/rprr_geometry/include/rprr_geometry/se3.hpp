// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rprr {

/// A rigid motion. Named M_ab it maps points from a's optical frame into b's: p_b = M_ab p_a. (A
/// tf2 transform with parent a and child b is its inverse.)
using Pose = Eigen::Isometry3d;

/// Motion vector of the paper's eq. 4: translation (alpha_1..3, metres), rotation (alpha_4..6,
/// rad).
using Twist = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Exponential map from se(3), paper eq. 4.
Pose exp_se3(const Twist& twist);
/// Logarithm to se(3), the inverse of exp_se3() for rotations below pi.
Twist log_se3(const Pose& pose);
/// Ad(T): exp(Ad(T) x) = T exp(x) T^-1.
Matrix6 adjoint(const Pose& pose);

/// Angle of a rotation, rad, in [0, pi].
double rotation_angle(const Eigen::Matrix3d& rotation);

/// A pose from a translation and a quaternion (x, y, z, w) that need not be of unit length;
/// identity rotation if its length is not usable.
Pose make_pose(const Eigen::Vector3d& translation, const Eigen::Vector4d& xyzw);

/// What the pose would be after crossing the radio as float64 translation and quaternion is itself;
/// this only tells whether all of it is finite and its rotation orthonormal within 1e-6.
bool is_rigid(const Pose& pose);

}  // namespace rprr
