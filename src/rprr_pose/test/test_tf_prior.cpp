// SPDX-License-Identifier: BSD-3-Clause
#include "tf_prior.hpp"

#include <gtest/gtest.h>

#include "rprr_ros/conversions.hpp"
#include "synthetic_views.hpp"
#include "transforms.hpp"

namespace rprr {
namespace {

const char* const kA = "a_rgb_optical_frame";
const char* const kB = "b_rgb_optical_frame";
constexpr Stamp kSecond = 1000000000;
constexpr Stamp kThen = 100 * kSecond;
constexpr Stamp kNow = 103 * kSecond;

const Pose kLast = test_motion(0.2, 10.0);
// Cameras in their odometry frames, then and now.
const Pose kAThen = test_motion(1.0, 20.0);
const Pose kANow = test_motion(1.3, 35.0);
const Pose kBThen = test_motion(2.0, -40.0);
const Pose kBNow = test_motion(2.2, -55.0);

class TfPriorTest : public ::testing::Test {
 protected:
  TfPriorTest() {
    options.robot = "a";
    options.peer = "b";
  }
  // tf2's way: the pose of the child in the parent.
  void set(const std::string& parent, const std::string& child, Stamp at, const Pose& pose,
           bool is_static = false) {
    geometry_msgs::TransformStamped message;
    message.header.stamp = to_time(at);
    message.header.frame_id = parent;
    message.child_frame_id = child;
    message.transform = to_transform(pose);
    buffer.setTransform(message, "test", is_static);
  }
  void set_odometry_of_a() {
    set("a/odom", kA, kThen, kAThen);
    set("a/odom", kA, kNow, kANow);
  }
  void set_odometry_of_b() {
    set("b/odom", kB, kThen, kBThen);
    set("b/odom", kB, kNow, kBNow);
  }
  std::vector<Pose> propose(bool with_last = true, Stamp now = kNow) {
    std::optional<KnownPose> last;
    if (with_last) last = KnownPose{{kThen, kA, kThen, kB}, kLast};
    TfPrior prior(buffer, options);
    std::vector<Pose> poses = prior.propose({now, kA, now, kB}, last);
    complaint = prior.take_complaint();
    return poses;
  }
  static Pose carried(const Pose& a_then, const Pose& a_now, const Pose& b_then,
                      const Pose& b_now) {
    return b_now.inverse() * b_then * kLast * a_then.inverse() * a_now;
  }

  TfPriorOptions options;
  tf2::BufferCore buffer;
  std::string complaint;
};

TEST_F(TfPriorTest, WithoutTfThereIsNothingToPropose) {
  EXPECT_TRUE(propose().empty());
  EXPECT_TRUE(complaint.empty()) << "nobody asked for tf";
}

TEST_F(TfPriorTest, ThroughACommonTreeAtBothStamps) {
  set("map", kA, kNow, kANow);
  set("map", kB, kNow, kBNow);
  const auto poses = propose(false);
  ASSERT_EQ(poses.size(), 1u);
  // p_b = M_ab p_a, with both cameras' poses in the map.
  EXPECT_TRUE(poses[0].isApprox(kBNow.inverse() * kANow, 1e-9));
}

TEST_F(TfPriorTest, StampsOfTheTwoFramesMayDiffer) {
  set("map", kA, kThen, kAThen);
  set("map", kA, kNow, kANow);
  set("map", kB, kThen, kBThen);
  set("map", kB, kNow, kBNow);
  TfPrior prior(buffer, options);
  const auto poses = prior.propose({kThen, kA, kNow, kB}, std::nullopt);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_TRUE(poses[0].isApprox(kBNow.inverse() * kAThen, 1e-9));
}

TEST_F(TfPriorTest, FramesOfOldBagsAreCleaned) {
  set("map", kA, 0, kANow, true);
  set("map", kB, 0, kBNow, true);
  TfPrior prior(buffer, options);
  const auto poses = prior.propose({kNow, std::string("/") + kA, kNow, kB}, std::nullopt);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_TRUE(poses[0].isApprox(kBNow.inverse() * kANow, 1e-9));
}

TEST_F(TfPriorTest, OdometryOfBothCarriesTheLastPose) {
  set_odometry_of_a();
  set_odometry_of_b();
  const auto poses = propose();
  ASSERT_EQ(poses.size(), 1u) << "no common tree";
  EXPECT_TRUE(poses[0].isApprox(carried(kAThen, kANow, kBThen, kBNow), 1e-9));
}

TEST_F(TfPriorTest, ARobotWithoutOdometryStandsStill) {
  const Pose stays = Pose::Identity();
  set_odometry_of_b();
  auto poses = propose();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_TRUE(poses[0].isApprox(carried(stays, stays, kBThen, kBNow), 1e-9));
  buffer.clear();
  set_odometry_of_a();
  poses = propose();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_TRUE(poses[0].isApprox(carried(kAThen, kANow, stays, stays), 1e-9));
}

TEST_F(TfPriorTest, ThePoseThenIsRememberedLongerThanTfDoes) {
  set_odometry_of_b();
  TfPrior prior(buffer, options);
  const KnownPose last{{kThen, kA, kThen, kB}, kLast};
  ASSERT_EQ(prior.propose({kNow, kA, kNow, kB}, last).size(), 1u);
  const Stamp later = kThen + 60 * kSecond;  // tf keeps ten seconds
  set("b/odom", kB, later, kBThen);
  const auto poses = prior.propose({later, kA, later, kB}, last);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_TRUE(poses[0].isApprox(kLast, 1e-9)) << "b is back where it was";
}

TEST_F(TfPriorTest, TfALittleLateWillDoAndOldTfWillNot) {
  set_odometry_of_b();
  EXPECT_EQ(propose(true, kNow + kSecond / 10).size(), 1u);
  EXPECT_TRUE(propose(true, kNow + kSecond).empty());
}

TEST_F(TfPriorTest, WhatWePublishIsNoEvidenceOfItself) {
  // Our own frame, and a tree of b's that somebody hung below it.
  set(kA, "b_rprr_optical_frame", kThen, kLast.inverse());
  set(kA, "b_rprr_optical_frame", kNow, kLast.inverse());
  EXPECT_TRUE(propose().empty());
  set("b_rprr_optical_frame", kB, 0, Pose::Identity(), true);
  EXPECT_TRUE(propose().empty());
  TfPrior prior(buffer, options);
  EXPECT_TRUE(prior.propose({kNow, kA, kNow, "b_rprr_optical_frame"}, std::nullopt).empty());
}

TEST_F(TfPriorTest, BelowTheRootThatWePublishOdometryStillCounts) {
  options.publishes_root = true;
  set_odometry_of_a();
  set_odometry_of_b();
  set(kA, "b/odom", kThen, kLast.inverse() * kBThen.inverse());
  set(kA, "b/odom", kNow, kLast.inverse() * kBThen.inverse());
  const auto poses = propose();
  ASSERT_EQ(poses.size(), 1u) << "carried only: the tree is tied together by ourselves";
  EXPECT_TRUE(poses[0].isApprox(carried(kAThen, kANow, kBThen, kBNow), 1e-9));
}

TEST_F(TfPriorTest, FramesMayBeConfigured) {
  options.fixed_frame = "map";
  options.odom_frame = "{robot}/odom";
  set("earth", "map", 0, test_motion(5.0, 30.0), true);
  for (const Stamp at : {kThen, kNow}) {  // the map jumps, odometry does not
    const Pose jump = test_motion(at == kNow ? 0.5 : 0.0, 0.0);
    set("map", "a/odom", at, jump);
    set("map", "b/odom", at, Pose::Identity());
  }
  set_odometry_of_a();
  set_odometry_of_b();
  const auto poses = propose();
  EXPECT_TRUE(complaint.empty()) << complaint;
  ASSERT_EQ(poses.size(), 2u) << "carried first, then through the tree";
  EXPECT_TRUE(poses[0].isApprox(carried(kAThen, kANow, kBThen, kBNow), 1e-9));
  EXPECT_TRUE(poses[1].isApprox(kBNow.inverse() * test_motion(0.5, 0.0) * kANow, 1e-9));
}

TEST_F(TfPriorTest, OnlyWhatWasConfiguredIsMissed) {
  set_odometry_of_a();
  options.fixed_frame = "map";
  propose();
  EXPECT_NE(complaint.find("tf_prior_fixed_frame"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("map"), std::string::npos) << complaint;
  options.fixed_frame.clear();
  options.odom_frame = "{robot}/odom";
  propose();
  EXPECT_NE(complaint.find("b/odom"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find(kB), std::string::npos) << complaint;
  propose();
  set_odometry_of_b();
  propose();
  EXPECT_TRUE(complaint.empty()) << complaint;
}

TEST_F(TfPriorTest, AFixedFrameAboveOneCameraAloneProposesNothing) {
  options.fixed_frame = "map";
  set("map", kA, kNow, kANow);
  EXPECT_TRUE(propose(false).empty());
  EXPECT_NE(complaint.find(kB), std::string::npos) << complaint;
}

TEST_F(TfPriorTest, HostileFrameNamesAreHarmless) {
  set("map", kA, kNow, kANow);
  TfPrior prior(buffer, options);
  const KnownPose last{{kThen, kA, kThen, kB}, kLast};
  for (const std::string& name : {std::string(), std::string("/"), std::string(kA),
                                  std::string(100000, 'x'), std::string("\0\n", 2)}) {
    for (const Stamp at : {kNow, Stamp{-1}, Stamp{0}}) {
      EXPECT_TRUE(prior.propose({at, kA, at, name}, std::nullopt).empty());
      prior.propose({at, kA, at, name}, last);
    }
  }
}

}  // namespace
}  // namespace rprr
