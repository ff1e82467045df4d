// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "registration_cases.hpp"

namespace rprr {
namespace {

TEST(IcpIvd, FindsAKnownMotionFromTheIdentity) {
  expect_finds(*make_icp_ivd(), test_motion(0.05, 3.0), 0.012, 0.5);
}

TEST(IcpIvd, StartsWhereItIsTold) {
  expect_start_counts(*make_icp_ivd(), test_motion(0.08, 4.0), 0.02);
}

TEST(IcpIvd, GivesTheSameTwice) {
  expect_same_twice(*make_icp_ivd());
}

TEST(IcpIvd, SurvivesFramesWithoutDepth) {
  expect_survives_empty_frames(*make_icp_ivd());
}

TEST(IcpIvd, StopsAtItsLimit) {
  const auto a = corner_frame(Pose::Identity(), 1, "a");
  const auto b = corner_frame(test_motion(0.1, 5.0), 2, "b");
  const auto method = make_icp_ivd({2, 1e-9, 1e-9});
  const RegistrationResult result = method->align(*a, *b, Pose::Identity());
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 2);
}

}  // namespace
}  // namespace rprr
