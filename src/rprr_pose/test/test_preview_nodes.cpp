// SPDX-License-Identifier: BSD-3-Clause
// As test_exchange_nodes.cpp, with the protocol of previews: two robots' cameras and an attacker on
// their radio; the nodes are started by the .test files, as nodelets and as nodes.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>
#include <limits>

#include "preview_bench.hpp"
#include "rprr_pose/pose_verdict.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {
namespace {

TEST_F(PreviewNodes, OneMessageEachWayGivesTheTruePoseOnAllTopics) {
  ASSERT_TRUE(exchange()) << last_outcome();
  ASSERT_TRUE(accepted()) << last_outcome();
  const RelativePose& pose = *pose_of(stamp);
  EXPECT_EQ(pose.header.frame_id, "eyebug_a_rgb_optical_frame") << "slash cleaned";
  EXPECT_EQ(pose.dependent, "eyebug_b");
  EXPECT_EQ(pose.dependent_stamp, stamp);
  EXPECT_GT(pose.inliers, 100);
  EXPECT_GT(pose.covariance[0], 0.0f);

  ASSERT_EQ(previews.messages.size(), 1u);
  const PreviewOfBlocks& preview = *previews.messages[0];
  EXPECT_EQ(preview.header.stamp, stamp);
  EXPECT_EQ(preview.header.frame_id, "eyebug_b_rgb_optical_frame");
  EXPECT_EQ(preview.receiver, "eyebug_a");
  EXPECT_EQ(preview.exchange, pose.exchange);
  EXPECT_TRUE(a_samples.messages.empty() && b_samples.messages.empty());
  EXPECT_TRUE(a_updates.messages.empty() && b_updates.messages.empty());

  ASSERT_TRUE(wait([this] { return a_events.messages.size() >= 2; }));
  ASSERT_EQ(a_events.messages.size(), 2u) << "predict, then send whole as the reference";
  EXPECT_EQ(a_events.messages[1]->action, ExchangeEvent::SEND_REFERENCE);
  const ExchangeEvent& at_a = *a_events.messages[0];
  EXPECT_EQ(at_a.action, ExchangeEvent::PREDICT);
  EXPECT_EQ(at_a.peer, "eyebug_b");
  const auto seen = decode_preview(at_a.peer_preview);
  ASSERT_TRUE(seen) << seen.reason();
  EXPECT_EQ(seen->grid.width, kTestCamera.width);
  ASSERT_EQ(b_events.messages.size(), 1u);
  const ExchangeEvent& at_b = *b_events.messages[0];
  EXPECT_EQ(at_b.frame.header.frame_id, "eyebug_b_rgb_optical_frame");
  EXPECT_TRUE(at_b.peer_preview.empty());
  for (const ExchangeEvent* told : {&at_a, &at_b}) {
    EXPECT_EQ(told->exchange, pose.exchange);
    EXPECT_EQ(told->frame.header.stamp, stamp);
    ByteReader reader{ByteView(told->peer_camera)};
    const auto camera = get_camera(reader);
    ASSERT_TRUE(camera) << camera.reason();
    EXPECT_EQ(camera_hash(*camera), camera_hash(kTestCamera));
    EXPECT_EQ(told->exchange_bytes, ros::serialization::serializationLength(preview) +
                                        ros::serialization::serializationLength(pose))
        << "bytes as they crossed the radio";
  }
  EXPECT_EQ(pose.bytes_spent, at_b.exchange_bytes);
}

std::string in_words(const RelativePose& pose) {
  return describe({pose_status_from(pose.status), pose_quantity_from(pose.quantity), pose.measured,
                   pose.needed});
}

TEST_F(PreviewNodes, BothRobotsShowTheVerdict) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  EXPECT_EQ(pose_of(stamp)->quantity, RelativePose::LOG_ODDS);
  EXPECT_GE(pose_of(stamp)->measured, pose_of(stamp)->needed);
  const std::string accepted = in_words(*pose_of(stamp));
  EXPECT_TRUE(shows("eyebug_a", "last verdict with eyebug_b", accepted)) << accepted;
  EXPECT_TRUE(shows("eyebug_b", "last verdict with eyebug_a", accepted)) << accepted;
  ASSERT_TRUE(exchange_elsewhere()) << last_outcome();
  const std::string rejected = in_words(*pose_of(stamp));
  EXPECT_NE(rejected.find("needs"), std::string::npos) << rejected;
  EXPECT_EQ(event_of(b_events, stamp)->reason, "pose rejected by eyebug_a: " + rejected);
  EXPECT_TRUE(service_is_back()) << last_outcome();
  EXPECT_TRUE(shows("eyebug_a", "last rejection with eyebug_b", rejected)) << rejected;
  EXPECT_TRUE(shows("eyebug_b", "last rejection with eyebug_a", rejected)) << rejected;
}

TEST_F(PreviewNodes, AcceptedPosesAreOnTf) {
  const std::string a_frame = "eyebug_a_rgb_optical_frame";
  const std::string b_frame = "eyebug_b_rprr_optical_frame";
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  // Nothing tells when the listener is connected: the first poses may be lost on it.
  bool heard = false;
  for (int i = 0; i < 10 && !heard; ++i) {
    ASSERT_TRUE(exchange() && accepted()) << last_outcome();
    heard = wait([&] { return buffer.canTransform(a_frame, b_frame, stamp); }, 1.0);
  }
  ASSERT_TRUE(heard) << "no tf of the accepted pose";
  const auto b_in_a = buffer.lookupTransform(a_frame, b_frame, stamp);
  const auto& t = b_in_a.transform.translation;
  const auto& r = b_in_a.transform.rotation;
  const Pose from_tf = make_pose({t.x, t.y, t.z}, {r.x, r.y, r.z, r.w});
  const RelativePose& pose = *pose_of(stamp);
  EXPECT_TRUE(from_tf.isApprox(pose_from_fields(pose.translation, pose.rotation).inverse(), 1e-9));
}

TEST_F(PreviewNodes, TfIsStampedWithBsFrame) {
  Inbox<tf2_msgs::TFMessage> tf(nh, "/tf");
  ASSERT_TRUE(wait([&] { return tf.connected(); }));
  ASSERT_TRUE(service_is_back()) << last_outcome();
  next_stamp();
  const ros::Time of_a = stamp + ros::Duration(0.03);
  b.show(stamp);
  a.show(of_a);
  ASSERT_TRUE(wait([&] { return pose_of(of_a) != nullptr; }));
  EXPECT_EQ(pose_of(of_a)->dependent_stamp, stamp);
  EXPECT_TRUE(wait([&] { return tf.messages.back()->transforms[0].header.stamp == stamp; }))
      << tf.messages.back()->transforms[0].header.stamp << ", b's frame is of " << stamp;
  EXPECT_EQ(tf.messages.back()->transforms[0].header.frame_id, "eyebug_a_rgb_optical_frame");
}

TEST_F(PreviewNodes, IntrinsicsCrossTheRadioOnce) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  ASSERT_TRUE(exchange() && accepted()) << last_outcome();
  const std::size_t without = previews.messages.back()->data.size();
  EXPECT_TRUE(pose_of(stamp)->reference_camera.empty());
  // b forgets that a knows its camera when a could not read a preview.
  previews.listener = [&](const PreviewOfBlocks& asked) {
    RelativePose pose = *poses.messages.back();
    pose.exchange = asked.exchange;
    pose.dependent_stamp = asked.header.stamp;
    pose.status = RelativePose::MALFORMED;
    pose.checksum = checksum_of(pose);
    radio_pose.publish(pose);
  };
  b.show(next_stamp());
  ASSERT_TRUE(wait([this] { return event_of(b_events, stamp) != nullptr; }));
  previews.listener = nullptr;
  ASSERT_TRUE(exchange() && accepted()) << last_outcome();
  EXPECT_EQ(previews.messages.back()->data.size(), without + kCameraBytes);
}

TEST_F(PreviewNodes, TheLastPoseSavesTheSearchWhileItHolds) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  ASSERT_TRUE(exchange() && accepted()) << last_outcome();
  EXPECT_TRUE(was_warm());
  ASSERT_TRUE(exchange_elsewhere()) << last_outcome();
  EXPECT_EQ(event_of(b_events, stamp)->action, ExchangeEvent::SEND_WHOLE);
  EXPECT_FALSE(event_of(b_events, stamp)->reason.empty());
  ASSERT_TRUE(exchange() && accepted()) << last_outcome();
  EXPECT_FALSE(was_warm()) << "the tf that we publish is no evidence of itself";
}

TEST_F(PreviewNodes, ASilentReferenceLetsBsFrameGoOutWhole) {
  b.show(stamp);
  ASSERT_TRUE(wait([this] { return event_of(b_events, stamp) != nullptr; }));
  EXPECT_EQ(event_of(b_events, stamp)->action, ExchangeEvent::SEND_WHOLE);
  EXPECT_NE(event_of(b_events, stamp)->reason.find("eyebug_a"), std::string::npos)
      << event_of(b_events, stamp)->reason;
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

TEST_F(PreviewNodes, BHearsThatNoFrameOfAIsNearInTime) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  const ros::Time of_a = stamp;
  b.show(stamp += ros::Duration(3.7));
  ASSERT_TRUE(wait([this] { return event_of(b_events, stamp) != nullptr; }));
  EXPECT_EQ(event_of(b_events, stamp)->action, ExchangeEvent::SEND_WHOLE);
  ASSERT_TRUE(wait([this] { return poses.messages.back()->dependent_stamp == stamp; }));
  EXPECT_EQ(poses.messages.back()->status, RelativePose::NO_FRAME);
  EXPECT_EQ(poses.messages.back()->header.stamp, of_a);
}

TEST_F(PreviewNodes, MotionDuringAnExchangeIsSaidByBoth) {
  const ros::Duration later(0.4);
  CameraOfRobot a_moved(nh, "eyebug_a", test_motion(0.05, 3.0));
  CameraOfRobot b_moved(nh, "eyebug_b", test_motion(0.2, 24.0));
  ASSERT_TRUE(wait([&] { return a_moved.connected() && b_moved.connected(); }));
  ASSERT_TRUE(service_is_back()) << last_outcome();
  // a has its later frame when it is asked, b when it is answered.
  next_stamp();
  b.show(stamp);
  b_moved.show(stamp + later);
  ASSERT_TRUE(wait([this] { return previews.messages.back()->header.stamp == stamp; }));
  a.show(stamp);
  ASSERT_TRUE(wait([&] { return motion_of(b_motions, stamp) != nullptr; })) << last_outcome();
  EXPECT_TRUE(accepted()) << "motion does the exchange no harm: " << last_outcome();
  const CameraMotionOfRobot& of_b = *motion_of(b_motions, stamp);
  EXPECT_EQ(of_b.header.stamp, stamp + later);
  EXPECT_EQ(of_b.header.frame_id, "eyebug_b_rgb_optical_frame");
  EXPECT_EQ(of_b.peer, "eyebug_a");
  EXPECT_EQ(of_b.exchange, pose_of(stamp)->exchange);
  ASSERT_EQ(of_b.outcome, CameraMotionOfRobot::MOVED);
  const Pose true_motion = test_motion(0.2, 24.0) * kTruth.inverse();
  const Pose motion = pose_from_fields(of_b.translation, of_b.rotation);
  EXPECT_LT(translation_error(motion, true_motion), 0.02);
  EXPECT_LT(rotation_error(motion, true_motion), 0.5);
  EXPECT_TRUE(complains("exchange", "eyebug_b", {"moved", "deg", "tf"})) << heard_;

  next_stamp();
  a.show(stamp);
  a_moved.show(stamp + later);
  b.show(stamp);
  ASSERT_TRUE(wait([&] { return motion_of(a_motions, stamp) != nullptr; })) << last_outcome();
  const CameraMotionOfRobot& of_a = *motion_of(a_motions, stamp);
  EXPECT_EQ(of_a.peer, "eyebug_b");
  ASSERT_EQ(of_a.outcome, CameraMotionOfRobot::MOVED);
  EXPECT_NEAR(of_a.degrees, 3.0f, 0.5f);
}

TEST_F(PreviewNodes, RobotsThatStandStillAreSaidToStandStill) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  const std::size_t said = a_motions.messages.size() + b_motions.messages.size();
  ASSERT_TRUE(exchange()) << last_outcome();
  wait([] { return false; }, 0.3);
  EXPECT_EQ(a_motions.messages.size() + b_motions.messages.size(), said) << "no newer frame";
  next_stamp();
  a.show(stamp);
  a.show(stamp + ros::Duration(0.4));
  b.show(stamp);
  ASSERT_TRUE(wait([&] { return motion_of(a_motions, stamp) != nullptr; })) << last_outcome();
  EXPECT_EQ(motion_of(a_motions, stamp)->outcome, CameraMotionOfRobot::STILL);
}

TEST_F(PreviewNodes, RolesChangeWhileTheNodesRunAndNoExchangeIsLost) {
  Inbox<RelativePose> poses_of_b(nh, "/eyebug_b/rprr/relative_pose");
  ASSERT_TRUE(wait([&] { return poses_of_b.connected(); }));
  ASSERT_TRUE(service_is_back()) << last_outcome();
  for (const bool b_refers : {false, true, false, true}) {
    ASSERT_TRUE(set_reference("b", "eyebug_a", b_refers));
    ASSERT_TRUE(set_reference("a", "eyebug_b", !b_refers));
    for (int i = 0; i < 3; ++i) {
      next_stamp();
      (b_refers ? a : b).show(stamp);
      (b_refers ? b : a).show(stamp);
      const auto& dependents = b_refers ? b_events : a_events;
      const auto& references = b_refers ? a_events : b_events;
      ASSERT_TRUE(wait([&] {
        return event_of(dependents, stamp) != nullptr && event_of(references, stamp) != nullptr;
      })) << (b_refers ? "b" : "a")
          << " got no answer";
      EXPECT_EQ(event_of(dependents, stamp)->action, ExchangeEvent::SEND_SPARSE)
          << event_of(dependents, stamp)->reason;
      EXPECT_EQ(event_of(references, stamp)->action, ExchangeEvent::PREDICT);
      const auto& told = b_refers ? poses : poses_of_b;
      EXPECT_EQ(told.messages.back()->status, RelativePose::ACCEPTED);
    }
  }
  EXPECT_FALSE(set_reference("a", "eyebug_x", true)) << "none of its peers";
}

TEST_F(PreviewNodes, ASilentDependentCostsNothing) {
  a.show(stamp);
  wait([] { return false; }, 0.3);
  EXPECT_EQ(pose_of(stamp), nullptr) << "a speaks when it is spoken to";
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

TEST_F(PreviewNodes, ABlackCameraEndsInARejectedPose) {
  CameraOfRobot::Frame dark = b.frame(stamp);
  std::fill(dark.depth.data.begin(), dark.depth.data.end(), std::uint8_t{0});
  std::fill(dark.rgb.data.begin(), dark.rgb.data.end(), std::uint8_t{0});
  b.show(dark);
  a.show(stamp);
  ASSERT_TRUE(wait([this] { return event_of(b_events, stamp) && pose_of(stamp); }));
  EXPECT_NE(pose_of(stamp)->status, RelativePose::ACCEPTED);
  EXPECT_EQ(event_of(b_events, stamp)->action, ExchangeEvent::SEND_WHOLE);
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

TEST_F(PreviewNodes, GarbageWhileNothingGoesOnIsRefusedAndReported) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  Attacker attacker;
  PreviewOfBlocks message = *previews.messages.back();
  const Bytes real = message.data;
  for (int i = 0; i < 16; ++i) {
    message.exchange += 1000;
    message.data = real;
    attacker.spoil(message.data, i % 4);
    radio_preview.publish(message);
  }
  message.exchange += 1000;
  message.data.assign(70000, 0xA5);  // longer than any message of an exchange
  radio_preview.publish(message);
  message.exchange += 1000;
  message.data.clear();
  radio_preview.publish(message);
  message.header.stamp = stamp + ros::Duration(1000);  // a frame that never comes
  message.data = real;
  radio_preview.publish(message);
  EXPECT_TRUE(complains("exchange", "eyebug_a", {"eyebug_b"})) << heard_;
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

TEST_F(PreviewNodes, GarbageDuringExchangesIsSurvived) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  Attacker attacker;
  attacker.answer(previews, radio_preview);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(exchange()) << "every frame is decided: " << last_outcome();
  }
  previews.listener = nullptr;
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

TEST_F(PreviewNodes, AForgedPoseThatIsNoPoseSendsBWhole) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  // Before a can answer, since it has no frame yet, b is told that all is well.
  const RelativePose real = *poses.messages.back();
  bool forged = false;
  previews.listener = [&](const PreviewOfBlocks& asked) {
    forged = true;
    RelativePose pose = real;
    pose.exchange = asked.exchange;
    pose.dependent_stamp = asked.header.stamp;
    pose.translation[1] = std::numeric_limits<double>::quiet_NaN();
    pose.covariance[3] = std::numeric_limits<float>::infinity();
    pose.checksum = checksum_of(pose);
    radio_pose.publish(pose);
  };
  b.show(next_stamp());
  ASSERT_TRUE(wait([this] { return event_of(b_events, stamp) != nullptr; }));
  previews.listener = nullptr;
  EXPECT_TRUE(forged);
  EXPECT_EQ(event_of(b_events, stamp)->action, ExchangeEvent::SEND_WHOLE);
  EXPECT_TRUE(complains("exchange", "eyebug_b", {"eyebug_a"})) << heard_;
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_preview_nodes");
  return RUN_ALL_TESTS();
}
