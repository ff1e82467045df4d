// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/verification.hpp"

#include <gtest/gtest.h>

#include "rprr_pose/icp_bd.hpp"
#include "synthetic_views.hpp"

namespace rprr {
namespace {

// Sums of a good pose, which each test then spoils in one way.
class Verification : public ::testing::Test {
 protected:
  void SetUp() override {
    const Pose truth = test_motion(0.1, 5.0);
    const DepthFrame a = corner_view(Pose::Identity(), true);
    const DepthFrame b = corner_view(truth, true);
    const SampledSurface a_points{kTestCamera, a.unit, sample_points(a, kTestCamera, 250, 1)};
    const SampledSurface b_points{kTestCamera, b.unit, sample_points(b, kTestCamera, 250, 2)};
    at_b = half_at_dependent(a_points, b, kTestCamera, truth, {});
    at_a = half_at_reference(b_points, a, kTestCamera, truth, {});
  }
  NormalEquations at_a, at_b;
};

TEST_F(Verification, TheTruthIsAccepted) {
  EXPECT_EQ(verify(at_b, at_a, {}), PoseStatus::kAccepted);
}

TEST_F(Verification, ViolationsInOneDirectionAreEnough) {
  at_a.violating = at_a.in_view / 5;
  EXPECT_EQ(verify(at_b, at_a, {}), PoseStatus::kFreeSpaceViolated);
}

TEST_F(Verification, DisagreeingSurfacesAreRefused) {
  at_b.consistent = at_b.in_view / 3;
  EXPECT_EQ(verify(at_b, at_a, {}), PoseStatus::kInconsistent);
}

TEST_F(Verification, ResidualsBeyondTheNoiseAreRefused) {
  at_b.sum_normalised2 *= 100.0;
  at_a.sum_normalised2 *= 100.0;
  EXPECT_EQ(verify(at_b, at_a, {}), PoseStatus::kInconsistent);
}

TEST_F(Verification, LittleOverlapIsSaid) {
  at_a.points = at_b.points = 2000;
  EXPECT_EQ(verify(at_b, at_a, {}), PoseStatus::kLittleOverlap);
}

TEST_F(Verification, NothingAtAllIsLittleOverlap) {
  EXPECT_EQ(verify({}, {}, {}), PoseStatus::kLittleOverlap);
}

TEST(VerificationOfPlanes, AWallIsDegenerate) {
  const DepthFrame wall{cv::Mat(240, 320, CV_16UC1, cv::Scalar(2000)), 0.001};
  const SampledSurface points{kTestCamera, wall.unit, sample_points(wall, kTestCamera, 250, 1)};
  const NormalEquations at_b = half_at_dependent(points, wall, kTestCamera, Pose::Identity(), {});
  const NormalEquations at_a = half_at_reference(points, wall, kTestCamera, Pose::Identity(), {});
  EXPECT_EQ(verify(at_b, at_a, {}), PoseStatus::kDegenerate);
}

TEST(PoseStatus, EveryStatusHasWords) {
  for (int i = 1; i <= 8; ++i) {
    EXPECT_GT(std::string(reason_of(static_cast<PoseStatus>(i))).size(), 5u) << i;
  }
  EXPECT_STREQ(reason_of(PoseStatus::kAccepted), "");
}

}  // namespace
}  // namespace rprr
