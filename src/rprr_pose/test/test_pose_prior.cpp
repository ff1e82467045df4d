// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_prior.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "near_in_time.hpp"
#include "rprr_pose/preview_protocol.hpp"
#include "textured_views.hpp"

namespace rprr {
namespace {

const Pose kTruth = test_motion(0.12, 6.0);
const Pose kElsewhere = test_motion(1.5, 100.0);

class MotionPriorTest : public ::testing::Test {
 protected:
  MotionPriorTest() : dependent(make_preview_dependent("b", "a", {})) {
    reference = make_preview_reference("a", "b", near_in_time(),
                                       [this](const std::string& peer, const FrameNames& now,
                                              const std::optional<KnownPose>& known) {
                                         asked_peer = peer;
                                         asked = now;
                                         last = known;
                                         return proposals;
                                       });
  }

  // One exchange over a channel without faults.
  RelativePoseMessage exchange(Stamp stamp, const Pose& b_from_a = kTruth) {
    RoleOutput at_a, at_b;
    reference->offer(textured_frame(Pose::Identity(), stamp, "a"), {}, at_a);
    dependent->offer(textured_frame(b_from_a, stamp + 5, "b"), {}, at_b);
    for (const PoseMessage& message : at_b.send) reference->receive("b", message, {}, at_a);
    for (const PoseMessage& message : at_a.send) dependent->receive("a", message, {}, at_b);
    return std::get<RelativePoseMessage>(at_a.send.at(0));
  }
  static void expect_right(const RelativePoseMessage& pose, const Pose& truth = kTruth) {
    EXPECT_TRUE(pose.verdict.accepted()) << describe(pose.verdict);
    EXPECT_LT(translation_error(pose.b_from_a, truth), 0.03);
    EXPECT_LT(rotation_error(pose.b_from_a, truth), 0.7);
  }

  std::vector<Pose> proposals;  // what the prior answers
  std::string asked_peer;       // of whom it was asked
  FrameNames asked;             // what it was asked
  std::optional<KnownPose> last;
  std::unique_ptr<ExchangeRole> reference, dependent;
};

TEST_F(MotionPriorTest, WithoutProposalsTheFirstExchangeSearches) {
  const RelativePoseMessage pose = exchange(1000);
  expect_right(pose);
  EXPECT_GT(pose.iterations, 1);
}

TEST_F(MotionPriorTest, ARightProposalSavesTheSearch) {
  proposals = {kTruth};
  const RelativePoseMessage pose = exchange(1000);
  expect_right(pose);
  EXPECT_EQ(pose.iterations, 1);
}

TEST_F(MotionPriorTest, ARoughProposalIsRefined) {
  proposals = {test_motion(0.03, 1.5) * kTruth};
  const RelativePoseMessage pose = exchange(1000);
  expect_right(pose);
  EXPECT_EQ(pose.iterations, 1);
}

TEST_F(MotionPriorTest, AWrongProposalDoesNoHarm) {
  proposals = {kElsewhere, kTruth.inverse() * test_motion(0.4, 15.0)};
  const RelativePoseMessage pose = exchange(1000);
  expect_right(pose);
  EXPECT_GT(pose.iterations, 1) << "found by search";
}

TEST_F(MotionPriorTest, WithoutEvidenceToSpareTheSearchDecides) {
  PreviewOptions options = near_in_time();
  options.search.limits.warm_evidence = 100.0;  // more than there can be
  reference = make_preview_reference(
      "a", "b", options,
      [](const std::string&, const FrameNames&, const std::optional<KnownPose>&) {
        return std::vector<Pose>{kTruth};
      });
  const RelativePoseMessage pose = exchange(1000);
  expect_right(pose);
  EXPECT_GT(pose.iterations, 1);
}

TEST_F(MotionPriorTest, AWrongProposalDoesNotHideTheLastAcceptedPose) {
  exchange(1000);
  proposals = {kElsewhere};
  const RelativePoseMessage pose = exchange(2000);
  expect_right(pose);
  EXPECT_EQ(pose.iterations, 1);
}

TEST_F(MotionPriorTest, AWrongProposalIsNotBelievedWhereNothingIsShared) {
  const Pose truth = test_motion(0.2, 150.0);
  proposals = {kTruth, Pose::Identity()};
  EXPECT_FALSE(exchange(1000, truth).verdict.accepted());
}

TEST_F(MotionPriorTest, WhatIsNoPoseIsPassedOver) {
  Pose broken = kTruth;
  broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
  Pose stretched = kTruth;
  stretched.linear() *= 1.1;
  proposals = {broken, stretched, kTruth};
  const RelativePoseMessage pose = exchange(1000);
  expect_right(pose);
  EXPECT_EQ(pose.iterations, 1);
}

TEST_F(MotionPriorTest, TooManyProposalsAreCutOff) {
  proposals.assign(1000, kElsewhere);
  proposals.push_back(kTruth);
  const RelativePoseMessage pose = exchange(1000);
  expect_right(pose);
  EXPECT_GT(pose.iterations, 1);
}

TEST_F(MotionPriorTest, IsAskedWithBothFramesAndTheLastAcceptedPose) {
  exchange(1000);
  EXPECT_EQ(asked.a_stamp, 1000);
  EXPECT_EQ(asked.b_stamp, 1005);
  EXPECT_EQ(asked.a_frame_id, "a_rgb_optical_frame");
  EXPECT_EQ(asked.b_frame_id, "b_rgb_optical_frame");
  EXPECT_FALSE(last) << "nothing was accepted yet";
  exchange(2000, test_motion(0.2, 150.0));
  ASSERT_TRUE(last);
  EXPECT_EQ(last->frames.a_stamp, 1000);
  EXPECT_EQ(last->frames.b_stamp, 1005);
  EXPECT_LT(translation_error(last->b_from_a, kTruth), 0.03);
  exchange(3000);
  ASSERT_TRUE(last) << "a rejected exchange does not forget";
  EXPECT_EQ(last->frames.a_stamp, 1000);
}

TEST_F(MotionPriorTest, ARobotThatMovedIsFollowedByItsOdometry) {
  exchange(1000);
  const Pose b_moved = test_motion(0.35, 14.0);
  proposals = {b_moved * kTruth};
  const RelativePoseMessage pose = exchange(2000, b_moved * kTruth);
  expect_right(pose, b_moved * kTruth);
  EXPECT_EQ(pose.iterations, 1);
}

}  // namespace
}  // namespace rprr
