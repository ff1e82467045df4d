// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/se3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rprr {
namespace {

Twist random_twist(std::mt19937& random, double scale) {
  std::normal_distribution<double> normal(0.0, scale);
  Twist twist;
  for (int i = 0; i < 6; ++i) twist[i] = normal(random);
  return twist;
}

TEST(Se3, LogUndoesExpAtAllScales) {
  std::mt19937 random(1);
  for (const double scale : {1e-9, 1e-5, 1e-2, 0.7}) {
    for (int i = 0; i < 50; ++i) {
      const Twist twist = random_twist(random, scale);
      EXPECT_LT((log_se3(exp_se3(twist)) - twist).norm(), 1e-8 * (1.0 + scale))
          << twist.transpose();
      EXPECT_TRUE(is_rigid(exp_se3(twist)));
    }
  }
}

TEST(Se3, GeneratorsMoveAsThePaperWritesThem) {
  Twist turn = Twist::Zero();
  turn[5] = M_PI / 2;  // G_6: about z, x towards y
  EXPECT_LT((exp_se3(turn) * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  Twist shift = Twist::Zero();
  shift[0] = 0.25;  // G_1: along x
  EXPECT_LT((exp_se3(shift) * Eigen::Vector3d::Zero() - Eigen::Vector3d(0.25, 0, 0)).norm(), 1e-12);
}

TEST(Se3, AdjointMovesATwistBetweenFrames) {
  std::mt19937 random(2);
  const Pose pose = exp_se3(random_twist(random, 0.5));
  const Twist twist = random_twist(random, 0.3);
  const Pose expected = pose * exp_se3(twist) * pose.inverse();
  EXPECT_LT((exp_se3(adjoint(pose) * twist).matrix() - expected.matrix()).norm(), 1e-9);
}

TEST(Se3, UnusableQuaternionGivesNoRotation) {
  const Pose pose = make_pose({1, 2, 3}, {0, 0, 0, 0});
  EXPECT_TRUE(is_rigid(pose));
  EXPECT_EQ(rotation_angle(pose.linear()), 0.0);
}

TEST(Se3, WhatIsNotRigidIsFound) {
  Pose pose = Pose::Identity();
  pose.linear() *= 1.01;
  EXPECT_FALSE(is_rigid(pose));
  pose = Pose::Identity();
  pose.translation().x() = std::nan("");
  EXPECT_FALSE(is_rigid(pose));
}

}  // namespace
}  // namespace rprr
