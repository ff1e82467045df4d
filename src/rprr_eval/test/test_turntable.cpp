// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/turntable/turntable.hpp"

#include <gtest/gtest.h>

#include "rprr_geometry/relative_pose.hpp"

namespace rprr {
namespace {

TurntableOptions small() {
  TurntableOptions options;
  options.seeds = 1;
  options.last_degrees = 10.0;
  options.width = 320;
  return options;
}

// Knows the truth only for the first angles: from `limit` on it stays at the start.
class Oracle final : public Registration {
 public:
  explicit Oracle(double limit) : limit_(limit) {}
  std::string name() const override { return "oracle"; }
  RegistrationResult align(const RgbdFrame& /*a*/, const RgbdFrame& b, const Pose& start) override {
    const double degrees = 5.0 * (to_seconds(b.stamp) - 1.0);
    RegistrationResult result;
    result.iterations = 3;
    result.accepted = result.converged = degrees < limit_;
    result.b_from_a = result.converged
                          ? relative_pose_of(turntable_camera(0.0), turntable_camera(degrees))
                          : start;
    return result;
  }

 private:
  double limit_;
};

TEST(Turntable, TurnsTheCameraRoundTheTableByTheAngle) {
  for (const double degrees : {5.0, 40.0}) {
    const Pose b_from_a = relative_pose_of(turntable_camera(0.0), turntable_camera(degrees));
    EXPECT_NEAR(rotation_angle(b_from_a.linear()) * 180.0 / M_PI, degrees, 1e-9);
  }
  // The middle of the table stays on the optical axis.
  const Eigen::Vector3d gaze = turntable_camera(25.0).inverse() * Eigen::Vector3d(0.0, 0.0, 0.08);
  EXPECT_NEAR(gaze.head<2>().norm(), 0.0, 1e-9);
  EXPECT_NEAR(gaze.z(), 1.1, 1e-9);
}

TEST(Turntable, ExcludesTheBackground) {
  const TurntableViews views = render_turntable(3, small());
  ASSERT_EQ(views.frames.size(), 3u);
  const DepthFrame& depth = views.frames[0]->depth;
  int valid = 0;
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      const double z = depth.metres(u, v);
      if (z <= 0.0) continue;
      ++valid;
      const Eigen::Vector3d world =
          views.world_from_camera[0] * views.frames[0]->camera.unproject(u, v, z);
      EXPECT_LT(world.head<2>().norm(), 0.42) << "pixel " << u << ", " << v;
    }
  }
  EXPECT_GT(valid, depth.height() * depth.width() / 12) << "the table fills part of the view";
  EXPECT_LT(valid, depth.height() * depth.width() * 3 / 4);
}

TEST(Turntable, OtherSeedsAreOtherTables) {
  EXPECT_NE(make_turntable(1).primitives().front().material.seed,
            make_turntable(2).primitives().front().material.seed);
}

TEST(Turntable, TalliesErrorsAndLimits) {
  std::vector<std::unique_ptr<Registration>> methods;
  methods.push_back(std::make_unique<Oracle>(9.0));
  const auto points = run_turntable(small(), methods);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].solved, 1);
  EXPECT_NEAR(points[0].rms_degrees, 0.0, 1e-6);
  EXPECT_EQ(points[1].solved, 0);
  EXPECT_NEAR(points[1].rms_degrees, 10.0, 1e-6) << "it stayed at the identity";
  EXPECT_NEAR(points[1].mean_iterations, 3.0, 1e-9);
  const auto limits = turntable_limits(points);
  ASSERT_EQ(limits.size(), 1u);
  EXPECT_EQ(limits[0].first_miss, 10.0);
  EXPECT_EQ(limits[0].first_fails, 10.0);
}

TEST(Turntable, TheBaselinesSolveFiveDegrees) {
  TurntableOptions options = small();
  options.last_degrees = 5.0;
  std::vector<std::unique_ptr<Registration>> methods;
  methods.push_back(make_icp());
  methods.push_back(make_icp_ivd());
  methods.push_back(make_icp_bd());
  for (const TurntablePoint& point : run_turntable(options, methods)) {
    EXPECT_EQ(point.solved, 1) << point.method << ": " << point.rms_degrees << " deg";
  }
}

}  // namespace
}  // namespace rprr
