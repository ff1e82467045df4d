// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "registration_cases.hpp"

namespace rprr {
namespace {

// Points without a counterpart pull it away from the truth: it has no rejection.
TEST(Icp, FindsAKnownMotionFromTheIdentity) {
  expect_finds(*make_icp(), test_motion(0.05, 3.0), 0.05, 1.5);
}

TEST(Icp, StartsWhereItIsTold) {
  expect_start_counts(*make_icp(), test_motion(0.08, 4.0), 0.05);
}

TEST(Icp, GivesTheSameTwice) {
  expect_same_twice(*make_icp());
}

TEST(Icp, SurvivesFramesWithoutDepth) {
  expect_survives_empty_frames(*make_icp());
}

TEST(Icp, StopsAtItsLimit) {
  const auto a = corner_frame(Pose::Identity(), 1, "a");
  const auto b = corner_frame(test_motion(0.1, 5.0), 2, "b");
  const auto method = make_icp({2, 1e-9, 1e-9});
  const RegistrationResult result = method->align(*a, *b, Pose::Identity());
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 2);
}

}  // namespace
}  // namespace rprr
