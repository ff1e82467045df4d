// SPDX-License-Identifier: BSD-3-Clause
// Plays two robots' cameras, and an attacker on their radio; Exchange of eyebug_a and of eyebug_b
// are started by the .test files, as nodelets and as nodes.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "exchange_bench.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

// The first of all, since nodes remember the camera_info that they once had.
TEST_F(ExchangeNodes, MissingCameraInfoIsReported) {
  b.show(b.frame(stamp), false);
  EXPECT_TRUE(
      complains("exchange", "eyebug_b", {"/eyebug_b/camera/rgb/camera_info", "start", "remap"}))
      << heard_;
  a.show(a.frame(stamp), false);
  EXPECT_TRUE(
      complains("exchange", "eyebug_a", {"/eyebug_a/camera/rgb/camera_info", "start", "remap"}))
      << heard_;
  EXPECT_TRUE(b_events.messages.empty()) << "nothing is made of images without camera_info";
  ASSERT_TRUE(exchange()) << last_outcome();
  EXPECT_TRUE(accepted()) << last_outcome();
}

TEST_F(ExchangeNodes, AnExchangeEndsWithTheTruePoseOnAllTopics) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  wait([&] { return false; }, 0.5);  // the listener's connections
  ASSERT_TRUE(exchange()) << last_outcome();
  ASSERT_TRUE(accepted()) << last_outcome();
  const RelativePose& pose = *pose_of(stamp);
  EXPECT_EQ(pose.header.frame_id, "eyebug_a_rgb_optical_frame") << "slash cleaned";
  EXPECT_EQ(pose.dependent, "eyebug_b");
  EXPECT_EQ(pose.dependent_stamp, stamp);
  EXPECT_GT(pose.inliers, 100);
  EXPECT_GT(pose.covariance[0], 0.0f);

  // Topics overtake each other.
  wait([this] { return a_events.messages.size() >= 2 && !b_events.messages.empty(); });
  ASSERT_EQ(a_events.messages.size(), 2u) << "send whole as the reference, then predict";
  EXPECT_EQ(a_events.messages[0]->action, ExchangeEvent::SEND_REFERENCE);
  EXPECT_EQ(a_events.messages[1]->action, ExchangeEvent::PREDICT);
  for (const auto& event : a_events.messages) {
    EXPECT_EQ(event->peer, "eyebug_b");
    EXPECT_EQ(event->exchange, pose.exchange);
    EXPECT_EQ(event->frame.header.stamp, stamp);
  }
  ASSERT_EQ(b_events.messages.size(), 1u);
  const ExchangeEvent& event = *b_events.messages[0];
  EXPECT_EQ(event.peer, "eyebug_a");
  EXPECT_EQ(event.exchange, pose.exchange);
  EXPECT_EQ(event.frame.header.frame_id, "eyebug_b_rgb_optical_frame");
  EXPECT_TRUE(pose_from_fields(event.pose.translation, event.pose.rotation)
                  .isApprox(pose_from_fields(pose.translation, pose.rotation), 1e-9));
  for (const ExchangeEvent* told : {&event, a_events.messages[1].get()}) {
    ByteReader reader{ByteView(told->peer_camera)};
    const auto camera = get_camera(reader);
    ASSERT_TRUE(camera) << camera.reason();
    EXPECT_EQ(camera_hash(*camera), camera_hash(kTestCamera));
  }

  std::size_t bytes = ros::serialization::serializationLength(pose);
  for (const auto* inbox : {&a_samples, &b_samples}) {
    for (const auto& sent : inbox->messages)
      bytes += ros::serialization::serializationLength(*sent);
  }
  for (const auto* inbox : {&a_updates, &b_updates}) {
    for (const auto& sent : inbox->messages)
      bytes += ros::serialization::serializationLength(*sent);
  }
  EXPECT_EQ(pose.bytes_spent, bytes) << "bytes as they crossed the radio";
  EXPECT_EQ(event.exchange_bytes, bytes);

  ASSERT_TRUE(wait([&] {
    return buffer.canTransform("eyebug_a_rgb_optical_frame", "eyebug_b_rprr_optical_frame", stamp);
  })) << "no tf of the accepted pose";
  // Maps points of b into a: the pose of b in a, the inverse of M_ab.
  const auto b_in_a =
      buffer.lookupTransform("eyebug_a_rgb_optical_frame", "eyebug_b_rprr_optical_frame", stamp);
  const auto& t = b_in_a.transform.translation;
  const auto& r = b_in_a.transform.rotation;
  const Pose from_tf = make_pose({t.x, t.y, t.z}, {r.x, r.y, r.z, r.w});
  EXPECT_TRUE(from_tf.isApprox(pose_from_fields(pose.translation, pose.rotation).inverse(), 1e-9));
  EXPECT_LT(translation_error(from_tf.inverse(), kTruth), 0.01);
  EXPECT_GT(translation_error(from_tf, kTruth), 0.1) << "the test could not tell the directions";
}

TEST_F(ExchangeNodes, IntrinsicsCrossTheRadioOnce) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  const auto first = a_samples.messages.back()->data.size();
  ASSERT_TRUE(exchange() && accepted()) << last_outcome();
  EXPECT_LE(a_samples.messages.back()->data.size(), first);
  EXPECT_LT(a_samples.messages.back()->data.size(), 1094u + kCameraBytes + 10);
}

TEST_F(ExchangeNodes, ASilentReferenceLetsBsFrameGoOutWhole) {
  b.show(stamp);
  ASSERT_TRUE(wait([this] { return event_of(b_events, stamp) != nullptr; }));
  const ExchangeEvent& event = *event_of(b_events, stamp);
  EXPECT_EQ(event.action, ExchangeEvent::SEND_WHOLE);
  EXPECT_EQ(event.exchange, 0u);
  EXPECT_NE(event.reason.find("eyebug_a"), std::string::npos) << event.reason;
  ASSERT_TRUE(exchange() && accepted()) << "service is back: " << last_outcome();
}

TEST_F(ExchangeNodes, ASilentDependentCostsOneExchange) {
  a.show(stamp);
  ASSERT_TRUE(wait([this] { return pose_of(stamp) != nullptr; }));
  EXPECT_EQ(pose_of(stamp)->status, RelativePose::TIMED_OUT);
  ASSERT_NE(event_of(a_events, stamp), nullptr) << "the reference frame goes out all the same";
  EXPECT_EQ(event_of(a_events, stamp)->action, ExchangeEvent::SEND_REFERENCE);
  ASSERT_TRUE(exchange() && accepted()) << "service is back: " << last_outcome();
}

TEST_F(ExchangeNodes, ViewsThatShareNothingAreRejectedWithAReason) {
  CameraOfRobot elsewhere(nh, "eyebug_b", test_motion(0.2, 150.0));
  ASSERT_TRUE(wait([&] { return elsewhere.connected(); }));
  elsewhere.show(stamp);
  a.show(stamp);
  ASSERT_TRUE(wait([this] { return event_of(b_events, stamp) && pose_of(stamp); }));
  EXPECT_NE(pose_of(stamp)->status, RelativePose::ACCEPTED);
  EXPECT_EQ(event_of(b_events, stamp)->action, ExchangeEvent::SEND_WHOLE);
  EXPECT_FALSE(event_of(b_events, stamp)->reason.empty());
}

TEST_F(ExchangeNodes, WrongInputIsReportedAndTheNextGoodFrameServed) {
  const std::string rgb_topic = "/eyebug_b/camera/rgb/image_rect_color";
  const std::string depth_topic = "/eyebug_b/camera/depth_registered/image_rect";
  using Frame = CameraOfRobot::Frame;
  struct Case {
    std::string what;
    std::function<void(Frame&)> spoil;
    std::vector<std::string> words;  // topic, expectation, remedy
  };
  const cv::Mat half(120, 160, CV_16UC1, cv::Scalar(2000));
  const std::vector<Case> cases = {
      {"depth of another size",
       [&](Frame& f) { f.depth = to_image(f.depth.header, "16UC1", half); },
       {rgb_topic, depth_topic, "320x240", "160x120", "registered"}},
      {"camera_info of another size",
       [](Frame& f) { f.info.width = 640; },
       {rgb_topic, "/eyebug_b/camera/rgb/camera_info", "640x240", "resolution"}},
      {"camera_info without intrinsics",
       [](Frame& f) { f.info.K[0] = f.info.P[0] = 0.0; },
       {"/eyebug_b/camera/rgb/camera_info", "calibrate"}},
      {"depth of an encoding that is none",
       [](Frame& f) { f.depth.encoding = "8UC3"; },
       {depth_topic, "8UC3", "publish 16UC1"}},
      {"colour of an encoding that is none",
       [](Frame& f) { f.rgb.encoding = "16SC4"; },
       {rgb_topic, "16SC4", "publish bgr8"}},
      {"depth without pixels", [](Frame& f) { f.depth.data.clear(); }, {depth_topic, "check"}},
      {"colour without pixels",
       [](Frame& f) { f.rgb.data.clear(); },
       {rgb_topic, "empty", "check"}},
      {"depth message shorter than it says",
       [](Frame& f) { f.depth.data.resize(1000); },
       {depth_topic, "!= 1000", "check"}},
      {"depth without a single reading",
       [](Frame& f) { std::fill(f.depth.data.begin(), f.depth.data.end(), std::uint8_t{0}); },
       {depth_topic, "no reading", "check"}},
  };
  for (const Case& wrong : cases) {
    SCOPED_TRACE(wrong.what);
    Frame frame = b.frame(next_stamp());
    wrong.spoil(frame);
    b.show(frame);
    a.show(stamp);
    EXPECT_TRUE(complains("exchange", "eyebug_b", wrong.words))
        << "the last complaint was: " << heard_;
    EXPECT_TRUE(wait([this] { return event_of(a_events, stamp) && pose_of(stamp); }))
        << "a's frame goes out all the same";
    ASSERT_TRUE(exchange() && accepted()) << "the next good frame: " << last_outcome();
  }
}

TEST_F(ExchangeNodes, GarbageWhileNothingGoesOnIsHarmless) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  Attacker attacker;
  const auto flood = [&attacker](ros::Publisher& radio, auto message) {
    const Bytes real = message.data;
    for (int i = 0; i < 12; ++i) {
      message.exchange += static_cast<std::uint32_t>(i % 3);
      message.data = real;
      attacker.spoil(message.data, i % 4);
      radio.publish(message);
    }
    message.data.assign(70000, 0xA5);  // longer than any message of an exchange
    radio.publish(message);
    message.data.clear();
    radio.publish(message);
  };
  flood(radio_a_samples, *a_samples.messages.back());
  flood(radio_b_samples, *b_samples.messages.back());
  flood(radio_a_update, *a_updates.messages.back());
  flood(radio_b_update, *b_updates.messages.back());
  RelativePose pose = *poses.messages.back();
  pose.status = pose.quantity = 200;
  pose.measured = std::numeric_limits<float>::quiet_NaN();
  pose.checksum = checksum_of(pose);
  radio_pose.publish(pose);
  EXPECT_TRUE(complains("exchange", "eyebug_b", {"eyebug_a"})) << heard_;
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

TEST_F(ExchangeNodes, GarbageDuringExchangesIsSurvived) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  Attacker attacker;
  attacker.answer(a_samples, radio_a_samples);
  attacker.answer(a_updates, radio_a_update);
  attacker.answer(b_samples, radio_b_samples);
  attacker.answer(b_updates, radio_b_update);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(exchange()) << "every frame is decided: " << last_outcome();
  }
  for (auto* inbox : {&a_samples, &b_samples}) inbox->listener = nullptr;
  for (auto* inbox : {&a_updates, &b_updates}) inbox->listener = nullptr;
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

TEST_F(ExchangeNodes, AForgedPoseThatIsNoPoseSendsBWhole) {
  ASSERT_TRUE(service_is_back()) << last_outcome();
  // As soon as a speaks, b is told that all is well, with numbers that are no motion.
  bool forged = false;
  b_samples.listener = [&](const SamplePoints& answer) {
    if (forged) return;
    forged = true;
    RelativePose pose = *poses.messages.back();
    pose.exchange = answer.exchange;
    pose.dependent_stamp = answer.header.stamp;
    pose.translation[1] = std::numeric_limits<double>::quiet_NaN();
    pose.covariance[3] = std::numeric_limits<float>::infinity();
    pose.checksum = checksum_of(pose);
    radio_pose.publish(pose);
  };
  EXPECT_TRUE(exchange()) << last_outcome();
  b_samples.listener = nullptr;
  EXPECT_TRUE(forged);
  const ExchangeEvent* event = event_of(b_events, stamp);
  ASSERT_NE(event, nullptr);
  for (const double number : event->pose.translation) {
    EXPECT_TRUE(event->action == ExchangeEvent::SEND_WHOLE || std::isfinite(number))
        << "numbers that are no pose were passed on";
  }
  EXPECT_TRUE(service_is_back()) << last_outcome();
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_exchange_nodes");
  return RUN_ALL_TESTS();
}
