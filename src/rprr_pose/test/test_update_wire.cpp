// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/update_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "synthetic_views.hpp"

namespace rprr {
namespace {

PoseHalf example_half() {
  PoseHalf half;
  half.iteration = 3;
  NormalEquations& e = half.equations;
  e.add({0.1, 0.2, 1.5}, {0.11, 0.2, 1.49}, Eigen::Vector3d(0.1, 0.2, -1).normalized(), 0.8, 4e-6);
  e.add({-0.4, 0.1, 2.5}, {-0.4, 0.12, 2.5}, Eigen::Vector3d(1, 0.2, -1).normalized(), 0.5, 9e-6);
  e.points = 250;
  e.in_view = 200;
  e.consistent = 180;
  e.violating = 4;
  e.sum_abs_dz = 0.7;
  return half;
}

TEST(UpdateWire, RequestRoundTripsToTheRoundedPose) {
  const PoseRequest request{5, rounded_for_wire(test_motion(0.3, 20.0)), 0.0123f, false, 2};
  const Result<PoseRequest> back = decode_request(encode_request(request));
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(back->iteration, 5);
  EXPECT_EQ(back->points_iteration, 2);
  EXPECT_FALSE(back->by_noise);
  EXPECT_NEAR(back->c, 0.0123, 1e-7);
  EXPECT_LT((back->b_from_a.matrix() - request.b_from_a.matrix()).norm(), 1e-6);
}

TEST(UpdateWire, RoundingAPoseTwiceIsRoundingItOnce) {
  const Pose once = rounded_for_wire(test_motion(0.3, 20.0));
  EXPECT_LT((rounded_for_wire(once).matrix() - once.matrix()).norm(), 2e-7);
}

TEST(UpdateWire, HalfRoundTrips) {
  const PoseHalf half = example_half();
  const Result<PoseHalf> back = decode_half(encode_half(half));
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(back->iteration, 3);
  const double scale = half.equations.ktwk.norm();
  EXPECT_LT((back->equations.ktwk - half.equations.ktwk).norm(), 1e-6 * scale);
  EXPECT_LT((back->equations.ktwy - half.equations.ktwy).norm(), 1e-6);
  EXPECT_EQ(back->equations.in_view, 200u);
  EXPECT_EQ(back->equations.violating, 4u);
}

TEST(UpdateWire, KindsAreNotMixedUp) {
  EXPECT_FALSE(decode_half(encode_request({})));
  EXPECT_FALSE(decode_request(encode_half(example_half())));
}

TEST(UpdateWire, ImpossibleNumbersAreErrors) {
  PoseRequest request;
  request.b_from_a.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(decode_request(encode_request(request)));
  request = {};
  request.b_from_a.translation().x() = 1e6;
  EXPECT_FALSE(decode_request(encode_request(request)));
  request = {};
  request.c = -1.0;
  EXPECT_FALSE(decode_request(encode_request(request)));
  PoseHalf half = example_half();
  half.equations.in_view = 300;  // of 250 points
  EXPECT_FALSE(decode_half(encode_half(half)));
  half = example_half();
  half.equations.ktwk(2, 2) = -1.0;
  EXPECT_FALSE(decode_half(encode_half(half)));
  half = example_half();
  half.equations.sum_weight = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(decode_half(encode_half(half)));
}

TEST(UpdateWire, EveryCutIsAnErrorAndHostileBytesNeverCrash) {
  const Bytes good = encode_half(example_half());
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(decode_half(ByteView(good).first(size))) << "cut to " << size;
  }
  std::mt19937 random(8);
  for (int trial = 0; trial < 5000; ++trial) {
    Bytes bytes(good.begin(), good.end() - 4);
    for (int i = 0; i < 4; ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    seal(bytes);
    const Result<PoseHalf> half = decode_half(bytes);
    if (half) {
      ASSERT_TRUE(half->equations.ktwk.allFinite());
    }
    const Result<PoseRequest> request = decode_request(bytes);
    if (request) {
      ASSERT_TRUE(is_rigid(request->b_from_a));
    }
  }
}

}  // namespace
}  // namespace rprr
