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

TEST_F(Verification, TheTruthIsAcceptedAndSaysByHowMuch) {
  const PoseVerdict verdict = verify(at_b, at_a, {});
  EXPECT_TRUE(verdict.accepted()) << describe(verdict);
  ASSERT_NE(verdict.quantity, PoseQuantity::kNone);
  EXPECT_EQ(verdict.measured > verdict.needed, is_lower_limit(verdict.quantity))
      << describe(verdict);
}

TEST_F(Verification, AnAcceptedPoseNamesTheTestThatItNearlyFailed) {
  VerificationLimits limits;
  limits.min_matched = static_cast<int>(at_a.matched + at_b.matched);
  const PoseVerdict verdict = verify(at_b, at_a, limits);
  EXPECT_TRUE(verdict.accepted());
  EXPECT_EQ(verdict.quantity, PoseQuantity::kMatchedPoints);
  EXPECT_EQ(verdict.measured, verdict.needed);
}

TEST_F(Verification, ViolationsInOneDirectionAreEnough) {
  at_a.violating = at_a.in_view / 5;
  const PoseVerdict verdict = verify(at_b, at_a, {});
  EXPECT_EQ(verdict.status, PoseStatus::kFreeSpaceViolated);
  EXPECT_EQ(verdict.quantity, PoseQuantity::kFreeSpace);
  EXPECT_NEAR(verdict.measured, 0.2, 0.01);
  EXPECT_FLOAT_EQ(verdict.needed, 0.08f);
}

TEST_F(Verification, DisagreeingSurfacesAreRefused) {
  at_b.consistent = at_b.in_view / 3;
  const PoseVerdict verdict = verify(at_b, at_a, {});
  EXPECT_EQ(verdict.status, PoseStatus::kDepthDisagrees);
  EXPECT_EQ(verdict.quantity, PoseQuantity::kConsistent);
  EXPECT_LT(verdict.measured, 0.75f);
  EXPECT_GT(verdict.measured, 0.6f);
}

TEST_F(Verification, ResidualsBeyondTheNoiseAreRefused) {
  const PoseVerdict before = verify(at_b, at_a, {});
  ASSERT_TRUE(before.accepted());
  at_b.sum_normalised2 *= 100.0;
  at_a.sum_normalised2 *= 100.0;
  const PoseVerdict verdict = verify(at_b, at_a, {});
  EXPECT_EQ(verdict.status, PoseStatus::kDepthDisagrees);
  EXPECT_EQ(verdict.quantity, PoseQuantity::kResidual);
  EXPECT_GT(verdict.measured, verdict.needed);
}

TEST_F(Verification, LittleOverlapIsSaid) {
  at_a.points = at_b.points = 2000;
  const PoseVerdict verdict = verify(at_b, at_a, {});
  EXPECT_EQ(verdict.status, PoseStatus::kLittleOverlap);
  EXPECT_EQ(verdict.quantity, PoseQuantity::kOverlap);
  EXPECT_NEAR(verdict.measured, (at_a.in_view + at_b.in_view) / 4000.0, 1e-6);
}

TEST_F(Verification, NothingAtAllIsLittleOverlap) {
  EXPECT_EQ(describe(verify({}, {}, {})), "too little overlap: share of the view 0.00, needs 0.25");
}

TEST_F(Verification, FewMatchesInPlainViewAreNoMatterOfOverlap) {
  at_a.matched = at_b.matched = 20;
  EXPECT_EQ(describe(verify(at_b, at_a, {})), "too few points: matched points 40, needs 60");
}

TEST_F(Verification, SumsInOrderAreNoReasonForAnUnsolvedStep) {
  NormalEquations both = at_b;
  both += at_a;
  EXPECT_FALSE(why_unsolved(both, {}));
  both.points = 5000;
  ASSERT_TRUE(why_unsolved(both, {}));
  EXPECT_EQ(why_unsolved(both, {})->status, PoseStatus::kLittleOverlap);
}

TEST(VerificationOfPlanes, AWallLeavesADirectionFree) {
  const DepthFrame wall{cv::Mat(240, 320, CV_16UC1, cv::Scalar(2000)), 0.001};
  const SampledSurface points{kTestCamera, wall.unit, sample_points(wall, kTestCamera, 250, 1)};
  const NormalEquations at_b = half_at_dependent(points, wall, kTestCamera, Pose::Identity(), {});
  const NormalEquations at_a = half_at_reference(points, wall, kTestCamera, Pose::Identity(), {});
  const PoseVerdict verdict = verify(at_b, at_a, {});
  EXPECT_EQ(verdict.status, PoseStatus::kFreeDirection);
  EXPECT_EQ(verdict.quantity, PoseQuantity::kTranslationSigma);
  EXPECT_GT(verdict.measured, 0.1f) << "along the wall nothing holds it";
  NormalEquations both = at_b;
  both += at_a;
  ASSERT_TRUE(why_unsolved(both, {}));
  EXPECT_EQ(why_unsolved(both, {})->status, PoseStatus::kFreeDirection);
}

}  // namespace
}  // namespace rprr
