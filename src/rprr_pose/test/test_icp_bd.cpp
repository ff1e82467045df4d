// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/icp_bd.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "synthetic_views.hpp"

namespace rprr {
namespace {

struct Views {
  Pose truth;
  DepthFrame a, b;
  SampledSurface a_points, b_points;

  explicit Views(const Pose& b_from_a, bool quantised = false)
      : truth(b_from_a),
        a(corner_view(Pose::Identity(), quantised)),
        b(corner_view(b_from_a, quantised)) {
    a_points = {kTestCamera, a.unit, sample_points(a, kTestCamera, kSampleCount, 3)};
    b_points = {kTestCamera, b.unit, sample_points(b, kTestCamera, kSampleCount, 4)};
  }
  NormalEquations both(const Pose& m, const IcpWeights& weights) const {
    NormalEquations sum = half_at_dependent(a_points, b, kTestCamera, m, weights);
    sum += half_at_reference(b_points, a, kTestCamera, m, weights);
    return sum;
  }
};

// The whole point of conventions: a step computed from the sums must lead from the identity towards
// the true M_ab (p_b = M_ab p_a), not away from it.
TEST(IcpBd, IteratesFromTheIdentityToTheTruth) {
  for (const bool by_noise : {false, true}) {
    const Views views(test_motion(0.06, 3.0));
    Pose m = Pose::Identity();
    IcpWeights weights{0.0, by_noise};
    for (int i = 0; i < 30; ++i) {
      const NormalEquations sums = views.both(m, weights);
      Twist step;
      ASSERT_TRUE(solve(sums, step));
      m = exp_se3(step) * m;
      weights.c = sums.sum_abs_dz / sums.matched;
    }
    EXPECT_LT(translation_error(m, views.truth), 0.004) << "by noise: " << by_noise;
    EXPECT_LT(rotation_error(m, views.truth), 0.15) << "by noise: " << by_noise;
  }
}

TEST(IcpBd, EachHalfAlonePointsTheRightWay) {
  const Views views(test_motion(0.02, 0.5));
  for (const NormalEquations& half :
       {half_at_dependent(views.a_points, views.b, kTestCamera, Pose::Identity(), {}),
        half_at_reference(views.b_points, views.a, kTestCamera, Pose::Identity(), {})}) {
    Twist step;
    ASSERT_TRUE(solve(half, step));
    EXPECT_LT(translation_error(exp_se3(step), views.truth), 0.012);
  }
}

TEST(IcpBd, AtTheTruthNothingMovesAndPointsAgree) {
  const Views views(test_motion(0.1, 6.0));
  const NormalEquations sums = views.both(views.truth, {});
  Twist step;
  ASSERT_TRUE(solve(sums, step));
  EXPECT_LT(step.head<3>().norm(), 0.004);
  EXPECT_GT(sums.consistent, 0.95 * sums.in_view);
  EXPECT_EQ(sums.violating, 0u);
}

TEST(IcpBd, AWrongPoseShowsInTheCounts) {
  const Views views(test_motion(0.1, 6.0));
  const NormalEquations sums = views.both(test_motion(-0.5, -12.0), {});
  EXPECT_LT(sums.consistent, 0.8 * sums.in_view);
  EXPECT_GT(sums.violating, 0u);
}

TEST(IcpBd, GrossOutliersWeighLessThanInliers) {
  Views views(test_motion(0.03, 1.0));
  views.b.counts(cv::Rect(200, 60, 60, 120)).setTo(800);  // something that a does not see
  Pose m = Pose::Identity();
  IcpWeights weights;
  for (int i = 0; i < 20; ++i) {
    const NormalEquations sums = views.both(m, weights);
    Twist step;
    ASSERT_TRUE(solve(sums, step));
    m = exp_se3(step) * m;
    weights.c = sums.sum_abs_dz / sums.matched;
  }
  EXPECT_LT(translation_error(m, views.truth), 0.01);
}

TEST(IcpBd, APlaneAloneHasNoSmallCovariance) {
  const DepthFrame wall{cv::Mat(240, 320, CV_16UC1, cv::Scalar(2000)), 0.001};
  const SampledSurface points{kTestCamera, wall.unit,
                              sample_points(wall, kTestCamera, kSampleCount, 1)};
  const NormalEquations sums = half_at_dependent(points, wall, kTestCamera, Pose::Identity(), {});
  const Matrix6 covariance = covariance_of(sums);
  EXPECT_GT(covariance(0, 0), 1e-2) << "sliding along x is free";
  EXPECT_LT(covariance(2, 2), 1e-4) << "the distance is not";
}

TEST(IcpBd, NoCorrespondencesNoSolution) {
  Twist step;
  EXPECT_FALSE(solve(NormalEquations(), step));
}

}  // namespace
}  // namespace rprr
