// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ros/serialization.h>

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

TEST(MessageConversions, PosesComeBackAndUnknownStatusesAreMalformed) {
  RelativePoseMessage pose;
  pose.stamp = 1305031790645155000;
  pose.dependent_stamp = pose.stamp + 5;
  pose.status = PoseStatus::kDegenerate;
  pose.motion = test_motion(0.4, 30.0);
  pose.covariance = Matrix6::Identity();
  pose.covariance(0, 5) = pose.covariance(5, 0) = 0.25;
  const RelativePoseMessage back = from_ros(to_ros(pose));
  EXPECT_EQ(back.stamp, pose.stamp);
  EXPECT_EQ(back.dependent_stamp, pose.dependent_stamp);
  EXPECT_EQ(back.status, pose.status);
  EXPECT_LT((back.motion.matrix() - pose.motion.matrix()).norm(), 1e-12);
  EXPECT_LT((back.covariance - pose.covariance).norm(), 1e-6);
  rprr_msgs::RelativePose message = to_ros(pose);
  message.status = 200;
  EXPECT_EQ(from_ros(message).status, PoseStatus::kMalformed);
}

TEST(PoseSeal, HoldsOnTheWayAndBreaksWithAnyBitOfThePose) {
  RelativePoseMessage pose;
  pose.frame_id = "a_rgb_optical_frame";
  pose.dependent = "b";
  pose.motion = test_motion(0.4, 30.0);
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
  other.header.stamp += ros::Duration(0, 1);
  EXPECT_NE(other.checksum, checksum_of(other));
}

}  // namespace
}  // namespace rprr
