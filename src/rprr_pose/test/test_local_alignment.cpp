// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/local_alignment.hpp"

#include <gtest/gtest.h>

#include "synthetic_views.hpp"

namespace rprr {
namespace {

TEST(LocalAlignment, BridgesRotationsThatTheIdentityDoesNot) {
  const DepthFrame a = corner_view(Pose::Identity(), true);
  for (const double degrees : {0.0, 8.0, 16.0, -12.0}) {
    const Pose truth = test_motion(0.1, degrees);
    const DepthFrame b = corner_view(truth, true);
    const SampledSurface points{kTestCamera, b.unit,
                                sample_points(b, kTestCamera, kSampleCount, 5)};
    const LocalAlignment found = align_locally(points, a, kTestCamera);
    EXPECT_LT(translation_error(found.b_from_a, truth), 0.05) << degrees << " deg";
    EXPECT_LT(rotation_error(found.b_from_a, truth), 1.0) << degrees << " deg";
    EXPECT_GT(found.score, 0.5) << degrees << " deg";
  }
}

TEST(LocalAlignment, WithoutPointsItStaysAtTheStart) {
  const DepthFrame a = corner_view(Pose::Identity());
  const LocalAlignment found = align_locally({kTestCamera, 0.001, {}}, a, kTestCamera);
  EXPECT_EQ(found.score, 0.0);
  EXPECT_TRUE(is_rigid(found.b_from_a));
}

}  // namespace
}  // namespace rprr
