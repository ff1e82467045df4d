// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/se3.hpp"

#include <algorithm>
#include <cmath>

namespace rprr {
namespace {

Eigen::Matrix3d skew(const Eigen::Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

}  // namespace

Pose exp_se3(const Twist& twist) {
  const Eigen::Vector3d t = twist.head<3>();
  const Eigen::Vector3d w = twist.tail<3>();
  const double angle2 = w.squaredNorm();
  const double angle = std::sqrt(angle2);
  // (1 - cos x) / x^2 and (x - sin x) / x^3, by series where the quotients lose their digits.
  const bool small = angle < 1e-4;
  const double b = small ? 0.5 - angle2 / 24.0 : (1.0 - std::cos(angle)) / angle2;
  const double c =
      small ? 1.0 / 6.0 - angle2 / 120.0 : (angle - std::sin(angle)) / (angle2 * angle);
  const double a = small ? 1.0 - angle2 / 6.0 : std::sin(angle) / angle;
  const Eigen::Matrix3d k = skew(w);
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Matrix3d::Identity() + a * k + b * k * k;
  pose.translation() = (Eigen::Matrix3d::Identity() + b * k + c * k * k) * t;
  return pose;
}

Twist log_se3(const Pose& pose) {
  const Eigen::AngleAxisd rotation(Eigen::Quaterniond(pose.linear()).normalized());
  const Eigen::Vector3d w = rotation.angle() * rotation.axis();
  const double angle2 = w.squaredNorm();
  const double angle = std::sqrt(angle2);
  const Eigen::Matrix3d k = skew(w);
  const double d = angle < 1e-4
                       ? 1.0 / 12.0 + angle2 / 720.0
                       : 1.0 / angle2 - (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  Twist twist;
  twist.head<3>() =
      (Eigen::Matrix3d::Identity() - 0.5 * k + d * k * k) * Eigen::Vector3d(pose.translation());
  twist.tail<3>() = w;
  return twist;
}

Matrix6 adjoint(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  Matrix6 a = Matrix6::Zero();
  a.topLeftCorner<3, 3>() = r;
  a.topRightCorner<3, 3>() = skew(pose.translation()) * r;
  a.bottomRightCorner<3, 3>() = r;
  return a;
}

double rotation_angle(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(Eigen::Quaterniond(rotation).normalized()).angle();
}

Pose make_pose(const Eigen::Vector3d& translation, const Eigen::Vector4d& xyzw) {
  Pose pose = Pose::Identity();
  pose.translation() = translation;
  const double length = xyzw.norm();
  if (std::isfinite(length) && length > 1e-9) {
    const Eigen::Vector4d q = xyzw / length;
    pose.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
  }
  return pose;
}

bool is_rigid(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  return pose.matrix().allFinite() &&
         (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
         r.determinant() > 0.0;
}

}  // namespace rprr
