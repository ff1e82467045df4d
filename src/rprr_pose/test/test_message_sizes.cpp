// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <limits>
#include <utility>

#include "rprr_pose_ros/message_conversions.hpp"
#include "rprr_pose_ros/pose_seal.hpp"
#include "rprr_wire/bytes.hpp"
#include "synthetic_views.hpp"

namespace rprr {
namespace {

TEST(MessageSizes, TheCoreCountsWhatRosSerialises) {
  for (const std::size_t length : {0u, 1u, 1115u}) {
    SamplesMessage samples{1, "eyebug_a_rgb_optical_frame", "eyebug_b", 7, Bytes(length)};
    EXPECT_EQ(serialised_bytes(samples), ros::serialization::serializationLength(to_ros(samples)));
    UpdateMessage update{1, "b", 7, Bytes(length)};
    EXPECT_EQ(serialised_bytes(update), ros::serialization::serializationLength(to_ros(update)));
  }
  PreviewMessage preview{1, "eyebug_b_rgb_optical_frame", "a", 7, Bytes(2500)};
  EXPECT_EQ(serialised_bytes(preview), ros::serialization::serializationLength(to_ros(preview)));
  RelativePoseMessage pose;
  pose.reference_camera = Bytes(20);
  pose.frame_id = "eyebug_a_rgb_optical_frame";
  pose.dependent = "eyebug_b";
  EXPECT_EQ(serialised_bytes(pose), ros::serialization::serializationLength(to_ros(pose)));
  EXPECT_EQ(serialised_bytes(PoseMessage(pose)), serialised_bytes(pose));
}

TEST(MessageConversions, PosesComeBack) {
  RelativePoseMessage pose;
  pose.stamp = 1305031790645155000;
  pose.dependent_stamp = pose.stamp + 5;
  pose.verdict = {PoseStatus::kAmbiguous, PoseQuantity::kMargin, 0.02f, 0.06f};
  pose.b_from_a = test_motion(0.4, 30.0);
  pose.covariance = Matrix6::Identity();
  pose.covariance(0, 5) = pose.covariance(5, 0) = 0.25;
  const RelativePoseMessage back = from_ros(to_ros(pose));
  EXPECT_EQ(back.stamp, pose.stamp);
  EXPECT_EQ(back.dependent_stamp, pose.dependent_stamp);
  EXPECT_EQ(describe(back.verdict), describe(pose.verdict));
  EXPECT_LT((back.b_from_a.matrix() - pose.b_from_a.matrix()).norm(), 1e-12);
  EXPECT_LT((back.covariance - pose.covariance).norm(), 1e-6);
}

TEST(MessageConversions, EveryVerdictComesBackAndWhatIsNoneIsUnknown) {
  rprr_msgs::RelativePose message = to_ros(RelativePoseMessage());
  for (int i = 0; i < 256; ++i) {
    message.status = message.quantity = static_cast<std::uint8_t>(i);
    message.measured = static_cast<float>(i);
    message.needed = -static_cast<float>(i);
    const PoseVerdict verdict = from_ros(message).verdict;
    EXPECT_EQ(verdict.status, i <= 11 ? static_cast<PoseStatus>(i) : PoseStatus::kUnknown);
    EXPECT_EQ(verdict.quantity, i <= 14 ? static_cast<PoseQuantity>(i) : PoseQuantity::kUnknown);
    RelativePoseMessage pose;
    pose.verdict = verdict;
    const rprr_msgs::RelativePose again = to_ros(pose);
    EXPECT_EQ(again.status, i <= 11 ? i : 255);
    EXPECT_EQ(again.quantity, i <= 14 ? i : 255);
    EXPECT_EQ(again.measured, message.measured);
    EXPECT_EQ(again.needed, message.needed);
  }
}

TEST(MessageConversions, AVerdictThatIsNoneIsNotAcceptedAndSaysSo) {
  rprr_msgs::RelativePose message = to_ros(RelativePoseMessage());
  message.status = message.quantity = 200;
  message.measured = std::numeric_limits<float>::quiet_NaN();
  message.needed = std::numeric_limits<float>::infinity();
  const PoseVerdict verdict = from_ros(message).verdict;
  EXPECT_FALSE(verdict.accepted());
  const std::string text = describe(verdict);
  for (const char* words : {"unknown status", "unknown quantity", "not a number", "infinite"}) {
    EXPECT_NE(text.find(words), std::string::npos) << text;
  }
}

TEST(MessageConversions, TheConstantsOfTheMessageAreThoseOfTheCore) {
  using M = rprr_msgs::RelativePose;
  const std::pair<int, PoseStatus> statuses[] = {
      {M::ACCEPTED, PoseStatus::kAccepted},
      {M::TIMED_OUT, PoseStatus::kTimedOut},
      {M::TOO_FEW_POINTS, PoseStatus::kTooFewPoints},
      {M::NOT_CONVERGED, PoseStatus::kNotConverged},
      {M::FREE_DIRECTION, PoseStatus::kFreeDirection},
      {M::LITTLE_OVERLAP, PoseStatus::kLittleOverlap},
      {M::DEPTH_DISAGREES, PoseStatus::kDepthDisagrees},
      {M::FREE_SPACE_VIOLATED, PoseStatus::kFreeSpaceViolated},
      {M::MALFORMED, PoseStatus::kMalformed},
      {M::NO_FRAME, PoseStatus::kNoFrame},
      {M::AMBIGUOUS, PoseStatus::kAmbiguous},
      {M::COLOUR_DISAGREES, PoseStatus::kColourDisagrees}};
  for (const auto& [constant, status] : statuses) EXPECT_EQ(constant, static_cast<int>(status));
  const std::pair<int, PoseQuantity> quantities[] = {
      {M::NONE, PoseQuantity::kNone},
      {M::LOG_ODDS, PoseQuantity::kLogOdds},
      {M::MARGIN, PoseQuantity::kMargin},
      {M::OVERLAP, PoseQuantity::kOverlap},
      {M::FREE_SPACE, PoseQuantity::kFreeSpace},
      {M::CONSISTENT, PoseQuantity::kConsistent},
      {M::RESIDUAL, PoseQuantity::kResidual},
      {M::MATCHED_POINTS, PoseQuantity::kMatchedPoints},
      {M::VALID_POINTS, PoseQuantity::kValidPoints},
      {M::TRANSLATION_SIGMA, PoseQuantity::kTranslationSigma},
      {M::ROTATION_SIGMA, PoseQuantity::kRotationSigma},
      {M::TRANSLATION_STEP, PoseQuantity::kTranslationStep},
      {M::ROTATION_STEP, PoseQuantity::kRotationStep},
      {M::SILENCE, PoseQuantity::kSilence},
      {M::TIME_APART, PoseQuantity::kTimeApart}};
  for (const auto& [constant, quantity] : quantities)
    EXPECT_EQ(constant, static_cast<int>(quantity));
}

TEST(PoseSeal, HoldsOnTheWayAndBreaksWithAnyBitOfThePose) {
  RelativePoseMessage pose;
  pose.frame_id = "a_rgb_optical_frame";
  pose.dependent = "b";
  pose.b_from_a = test_motion(0.4, 30.0);
  pose.reference_camera = Bytes(20, 7);
  rprr_msgs::RelativePose message = to_ros(pose);
  message.header.seq = 1234;
  EXPECT_EQ(message.checksum, checksum_of(message)) << "the publisher counts messages";
  for (int i = 0; i < 3; ++i) {
    rprr_msgs::RelativePose damaged = message;
    damaged.translation[static_cast<std::size_t>(i)] += 1e-9;
    EXPECT_NE(damaged.checksum, checksum_of(damaged));
  }
  rprr_msgs::RelativePose other = message;
  other.status = 0;
  EXPECT_NE(other.checksum, checksum_of(other));
  other = message;
  other.measured += 1.0f;
  EXPECT_NE(other.checksum, checksum_of(other));
  other = message;
  other.header.stamp += ros::Duration(0, 1);
  EXPECT_NE(other.checksum, checksum_of(other));
}

}  // namespace
}  // namespace rprr
