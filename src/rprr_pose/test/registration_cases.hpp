// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "rprr_pose/registration.hpp"
#include "synthetic_views.hpp"

namespace rprr {

// What holds for every baseline; each has a test file that instantiates these with its own motion.

/// Starts at the identity, ends at M_ab (and not at its inverse).
inline void expect_finds(Registration& method, const Pose& truth, double metres, double degrees) {
  const auto a = corner_frame(Pose::Identity(), 1, "a");
  const auto b = corner_frame(truth, 2, "b");
  const RegistrationResult result = method.align(*a, *b, Pose::Identity());
  EXPECT_TRUE(result.converged) << method.name() << " after " << result.iterations;
  EXPECT_EQ(result.accepted, result.converged);
  EXPECT_GT(result.iterations, 0);
  EXPECT_LT(translation_error(result.b_from_a, truth), metres) << method.name();
  EXPECT_LT(rotation_error(result.b_from_a, truth), degrees) << method.name();
}

/// From the truth nothing moves far and it takes less than from the identity.
inline void expect_start_counts(Registration& method, const Pose& truth, double metres) {
  const auto a = corner_frame(Pose::Identity(), 1, "a");
  const auto b = corner_frame(truth, 2, "b");
  const RegistrationResult near = method.align(*a, *b, truth);
  const RegistrationResult far = method.align(*a, *b, Pose::Identity());
  EXPECT_TRUE(near.converged);
  EXPECT_LT(translation_error(near.b_from_a, truth), metres) << method.name();
  EXPECT_LE(near.iterations, far.iterations) << method.name();
}

inline void expect_same_twice(Registration& method) {
  const auto a = corner_frame(Pose::Identity(), 1, "a");
  const auto b = corner_frame(test_motion(0.05, 3.0), 2, "b");
  const RegistrationResult first = method.align(*a, *b, Pose::Identity());
  const RegistrationResult second = method.align(*a, *b, Pose::Identity());
  EXPECT_TRUE(first.b_from_a.matrix() == second.b_from_a.matrix()) << method.name();
  EXPECT_EQ(first.iterations, second.iterations);
}

/// Frames without depth end without convergence, with the start as the motion.
inline void expect_survives_empty_frames(Registration& method) {
  const auto a = corner_frame(Pose::Identity(), 1, "a");
  RgbdFrame empty = *a;
  empty.depth.counts = cv::Mat::zeros(a->depth.counts.size(), CV_16UC1);
  const Pose start = test_motion(0.1, 1.0);
  for (const auto& [left, right] : {std::pair(*a, empty), std::pair(empty, *a)}) {
    const RegistrationResult result = method.align(left, right, start);
    EXPECT_FALSE(result.converged) << method.name();
    EXPECT_FALSE(result.accepted) << method.name();
    EXPECT_TRUE(result.b_from_a.isApprox(start)) << method.name();
  }
}

}  // namespace rprr
