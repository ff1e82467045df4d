// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_synthetic/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "rprr_synthetic/random.hpp"

namespace rprr {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;

/// A person's walk on an ellipse, gaze outwards; `turn` is the angle on the ellipse.
Pose walker(double turn, double phase) {
  const Eigen::Vector3d eye(1.0 * std::cos(turn), 0.75 * std::sin(turn),
                            1.35 + 0.06 * std::sin(3.0 * turn + phase));
  const double yaw = turn + 0.35 * std::sin(2.0 * turn + phase);
  const double pitch = (-13.0 + 4.0 * std::sin(5.0 * turn + 2.0 * phase)) * kDegree;
  const double roll = 2.0 * kDegree * std::sin(7.0 * turn + phase);
  return look_along(eye, yaw, pitch, roll);
}

/// 1 at every tenth frame's excursion, 0 two frames away from it.
double excursion(int frame) {
  const int distance = std::abs(frame % 10 - 7);
  return std::max(0.0, 1.0 - 0.6 * distance);
}

}  // namespace

Pose look_along(const Eigen::Vector3d& eye, double yaw, double pitch, double roll) {
  const Eigen::Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                                std::sin(pitch));
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d rotation;
  rotation << right, forward.cross(right), forward;
  Pose pose = Pose::Identity();
  pose.translation() = eye;
  pose.linear() = rotation * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

std::vector<Pose> single_walk(int frames, std::uint32_t seed) {
  Random random(seed);
  const double start = random.between(0.0, 2.0 * kPi);
  const double phase = random.between(0.0, 2.0 * kPi);
  std::vector<Pose> poses;
  for (int k = 0; k < frames; ++k) poses.push_back(walker(start + 3.6 * kDegree * k, phase));
  return poses;
}

std::vector<PairPose> pair_walk(int frames, std::uint32_t seed) {
  Random random(seed);
  const double phase = random.between(0.0, 2.0 * kPi);
  const std::vector<Pose> walk = single_walk(frames, seed);
  std::vector<PairPose> pairs;
  for (int k = 0; k < frames; ++k) {
    const double wave = 0.5 + 0.5 * std::sin(0.9 * k + phase);
    const double away = excursion(k);
    const double side = 0.06 + 0.15 * wave + 0.10 * away;           // [m]
    const double yaw = (3.0 + 5.5 * wave + 12.0 * away) * kDegree;  // [rad]
    const double pitch = 2.0 * kDegree * std::sin(1.7 * k + phase);
    Pose a_from_b = Pose::Identity();
    a_from_b.translation() =
        Eigen::Vector3d(side, 0.03 * std::sin(1.3 * k + phase), 0.05 * std::cos(1.1 * k + phase));
    a_from_b.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()))
                            .toRotationMatrix();
    const Pose& a = walk[static_cast<std::size_t>(k)];
    pairs.push_back({a, a * a_from_b});
  }
  return pairs;
}

}  // namespace rprr
