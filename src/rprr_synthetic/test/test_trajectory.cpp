// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_synthetic/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rprr_geometry/relative_pose.hpp"
#include "rprr_synthetic/sensor_model.hpp"

namespace rprr {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

TEST(LookAlong, AxesOfTheOpticalFrame) {
  const Pose pose = look_along({1, 2, 3}, 0.0, 0.0, 0.0);
  EXPECT_TRUE((pose * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(2, 2, 3))) << "forward";
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 1, 3))) << "right";
  EXPECT_TRUE((pose * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(1, 2, 2))) << "down";
  EXPECT_GT((look_along({0, 0, 0}, 1.0, 0.3, 0.2) * Eigen::Vector3d(0, 0, 1)).z(), 0.0)
      << "pitch looks up";
}

TEST(Walk, StepsOfAPersonAndRigidPoses) {
  const std::vector<Pose> walk = single_walk(200, 4);
  ASSERT_EQ(walk.size(), 200u);
  for (std::size_t k = 1; k < walk.size(); ++k) {
    EXPECT_TRUE(is_rigid(walk[k]));
    const Pose step = relative_pose_of(walk[k - 1], walk[k]);
    EXPECT_LT(step.translation().norm(), 0.15);
    EXPECT_GT(step.translation().norm(), 0.02);
    EXPECT_LT(rotation_angle(step.rotation()), 9.0 * kDegree);
  }
}

TEST(PairWalk, MotionIsWithinBounds) {
  int usual = 0;
  for (const PairPose& pair : pair_walk(100, 6)) {
    const Pose b_from_a = relative_pose_of(pair.a, pair.b);
    const double angle = rotation_angle(b_from_a.rotation()) / kDegree;
    const double distance = b_from_a.translation().norm();
    EXPECT_GT(angle, 2.0);
    EXPECT_LT(angle, 26.0);
    EXPECT_GT(distance, 0.04);
    EXPECT_LT(distance, 0.40);
    usual += angle < 11.0 && distance < 0.27 ? 1 : 0;
  }
  EXPECT_GE(usual, 65) << "of 100";
}

/// The overlap of the design: a pixel a block of a on a depth of b within 2 cm + 1.5%.
double overlap(const Scene& room, const Camera& camera, const PairPose& pair) {
  const ExactView a = room.render(camera, pair.a);
  const ExactView b = room.render(camera, pair.b);
  const Pose b_from_a = relative_pose_of(pair.a, pair.b);
  int seen = 0;
  int all = 0;
  for (int v = 4; v < camera.height; v += 8) {
    for (int u = 4; u < camera.width; u += 8, ++all) {
      const Eigen::Vector3d p = b_from_a * camera.unproject(u, v, a.metres.at<float>(v, u));
      if (p.z() <= 0.0) continue;
      const Eigen::Vector2d pixel = camera.project(p);
      if (!camera.contains(pixel.x(), pixel.y())) continue;
      const double z = b.metres.at<float>(static_cast<int>(std::lround(pixel.y())),
                                          static_cast<int>(std::lround(pixel.x())));
      seen += std::abs(z - p.z()) < 0.02 + 0.015 * z ? 1 : 0;
    }
  }
  return static_cast<double>(seen) / all;
}

TEST(PairWalk, OverlapVariesAndIsMostlyHigh) {
  const Scene room = make_room(6);
  const Camera camera = example_sensor_a(320, 240).camera;
  int enough = 0;
  double least = 1.0;
  double most = 0.0;
  const std::vector<PairPose> walk = pair_walk(20, 6);
  for (const PairPose& pair : walk) {
    const double share = overlap(room, camera, pair);
    enough += share >= 0.4 ? 1 : 0;
    least = std::min(least, share);
    most = std::max(most, share);
  }
  EXPECT_GE(enough, 18) << "of 20";
  EXPECT_GT(most, 0.8);
  EXPECT_LT(least, 0.65);
}

}  // namespace
}  // namespace rprr
