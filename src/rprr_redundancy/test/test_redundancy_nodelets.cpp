// SPDX-License-Identifier: BSD-3-Clause
// Plays the pose exchange of two robots; Redundancy of eyebug_a and of eyebug_b are started by the
// .test files, as nodelets and as nodes.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/OutgoingFrame.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/image_encodings.h>

#include <cstring>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "rprr_redundancy/decision.hpp"
#include "rprr_redundancy/outgoing.hpp"
#include "rprr_redundancy/prediction.hpp"
#include "rprr_redundancy/validation.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/frame_message.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "rprr_wire/mask_wire.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {
namespace {

const Camera kCamera{160, 120, 140, 140, 79.5, 59.5};

DepthFrame depth_of(const std::string& robot) {
  DepthFrame frame{cv::Mat(120, 160, CV_16UC1, cv::Scalar(2000)), 0.001};
  if (robot == "eyebug_b") frame.counts(cv::Rect(0, 40, 16, 16)).setTo(500);
  return frame;
}

Pose b_from_a() {
  Pose pose = Pose::Identity();
  pose.translation().x() = 0.3;
  return pose;
}

// What a sees, and b 21 pixels further to the right: 0.3 m at 2 m.
cv::Mat colours_of(const std::string& robot) {
  const int shift = robot == "eyebug_b" ? 21 : 0;
  cv::Mat bgr(120, 160, CV_8UC3);
  for (int v = 0; v < bgr.rows; ++v) {
    for (int u = 0; u < bgr.cols; ++u) {
      bgr.at<cv::Vec3b>(v, u) = cv::Vec3b(static_cast<std::uint8_t>(60 + u - shift),
                                          static_cast<std::uint8_t>(80 + v), 100);
    }
  }
  return bgr;
}

// Blocks of b's preview in which it differs from what a predicts.
const cv::Rect kNearer(80, 40, 16, 16);
const cv::Rect kPainted(112, 80, 16, 16);

Bytes preview_of_b() {
  DepthFrame depth{depth_of("eyebug_b").counts.clone(), 0.001};
  cv::Mat bgr = colours_of("eyebug_b");
  depth.counts(kNearer).setTo(1000);
  bgr(kPainted).setTo(cv::Scalar(20, 20, 250));
  return encode_preview(make_preview(depth, bgr), 90);
}

template <typename T>
class Inbox {
 public:
  Inbox(ros::NodeHandle& nh, const std::string& topic)
      : subscriber_(nh.subscribe(topic, 20, &Inbox::receive, this)) {}
  std::vector<typename T::ConstPtr> messages;
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  void receive(const typename T::ConstPtr& message) { messages.push_back(message); }
  ros::Subscriber subscriber_;
};

class Robot {
 public:
  Robot(ros::NodeHandle& nh, const std::string& name)
      : name_(name),
        events_(nh.advertise<rprr_msgs::ExchangeEvent>("/" + name + "/rprr/exchange", 5)) {}

  bool connected() const { return events_.getNumSubscribers() > 0; }
  /// With the robot's frame of that stamp.
  void publish(rprr_msgs::ExchangeEvent event) {
    RgbdFrame frame;
    frame.stamp = to_stamp(event.frame.header.stamp);
    frame.frame_id = optical_frame(name_);
    frame.camera = rounded_for_wire(kCamera);
    frame.depth = depth_of(name_);
    frame.bgr = colours_of(name_);
    event.frame = to_message(frame);
    events_.publish(event);
  }

 private:
  std::string name_;
  ros::Publisher events_;
};

rprr_msgs::ExchangeEvent whole(ros::Time stamp, const std::string& peer) {
  rprr_msgs::ExchangeEvent event;
  event.frame.header.stamp = stamp;
  event.action = rprr_msgs::ExchangeEvent::SEND_WHOLE;
  event.peer = peer;
  event.reason = "a test";
  return event;
}

rprr_msgs::ExchangeEvent reference(ros::Time stamp, const std::string& peer) {
  rprr_msgs::ExchangeEvent event = whole(stamp, peer);
  event.action = rprr_msgs::ExchangeEvent::SEND_REFERENCE;
  return event;
}

// A pose was accepted: of a's frame the event that asks to predict, of b's that to send sparsely.
rprr_msgs::ExchangeEvent accepted(ros::Time stamp, const std::string& peer, std::uint32_t exchange,
                                  ros::Time a_stamp, ros::Time b_stamp) {
  rprr_msgs::ExchangeEvent event = whole(stamp, peer);
  event.action = peer == "eyebug_b" ? rprr_msgs::ExchangeEvent::PREDICT
                                    : rprr_msgs::ExchangeEvent::SEND_SPARSE;
  event.exchange = exchange;
  event.pose.status = rprr_msgs::RelativePose::ACCEPTED;
  event.pose.header.stamp = a_stamp;
  event.pose.dependent_stamp = b_stamp;
  event.pose.dependent = "eyebug_b";
  event.exchange_bytes = 5000;
  pose_to_fields(b_from_a(), event.pose.translation, event.pose.rotation);
  ByteWriter writer;
  put_camera(writer, kCamera);
  event.peer_camera = writer.take();
  return event;
}

class RedundancyNodes : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wait([this] {
      return a.connected() && b.connected() && a_out.connected() && b_out.connected() &&
             prediction.connected() && decision.connected() && points.connected() &&
             mask.connected() && validation.connected() && radio.getNumSubscribers() > 0;
    })) << "the nodelets do not listen on the fixed topics";
    a_stamp = ros::Time(1000 + 10 * ++tests, 123456789);
    b_stamp = a_stamp + ros::Duration(1);
  }
  static bool wait(const std::function<bool()>& condition, double seconds = 10) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::ok() && ros::WallTime::now() < end) {
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.01).sleep();
    }
    return false;
  }

  static int tests;
  ros::NodeHandle nh;
  Robot a{nh, "eyebug_a"};
  Robot b{nh, "eyebug_b"};
  ros::Publisher radio = nh.advertise<rprr_msgs::BlockMask>("/eyebug_a/rprr/prediction", 5);
  Inbox<rprr_msgs::OutgoingFrame> a_out{nh, "/eyebug_a/rprr/outgoing"};
  Inbox<rprr_msgs::OutgoingFrame> b_out{nh, "/eyebug_b/rprr/outgoing"};
  Inbox<rprr_msgs::BlockMask> prediction{nh, "/eyebug_a/rprr/prediction"};
  Inbox<sensor_msgs::Image> decision{nh, "/eyebug_a/rprr/decision"};
  Inbox<sensor_msgs::PointCloud2> points{nh, "/eyebug_a/rprr/preview_points"};
  Inbox<rprr_msgs::BlockMask> validation{nh, "/eyebug_b/rprr/validation"};
  Inbox<sensor_msgs::Image> mask{nh, "/eyebug_b/rprr/mask"};
  Inbox<sensor_msgs::Image> rgb{nh, "/eyebug_b/rprr/sparse/rgb"};
  Inbox<sensor_msgs::Image> depth{nh, "/eyebug_b/rprr/sparse/depth"};
  ros::Time a_stamp;
  ros::Time b_stamp;
};
int RedundancyNodes::tests = 0;

TEST_F(RedundancyNodes, AnExchangeFromEventsToOutgoingFrames) {
  a.publish(accepted(a_stamp, "eyebug_b", 7, a_stamp, b_stamp));
  a.publish(reference(a_stamp, "eyebug_b"));
  a.publish(reference(a_stamp, "eyebug_c"));  // another dependent, the same reference frame
  b.publish(accepted(b_stamp, "eyebug_a", 7, a_stamp, b_stamp));
  ASSERT_TRUE(wait([this] {
    return !a_out.messages.empty() && !b_out.messages.empty() && !mask.messages.empty() &&
           !rgb.messages.empty() && !depth.messages.empty() && !validation.messages.empty();
  }));
  wait([] { return false; }, 0.3);

  ASSERT_EQ(a_out.messages.size(), 1u) << "a reference frame goes out once";
  EXPECT_FALSE(a_out.messages[0]->sparse);
  EXPECT_EQ(a_out.messages[0]->frame.header.stamp, a_stamp);
  EXPECT_EQ(a_out.messages[0]->frame.header.frame_id, "eyebug_a_rgb_optical_frame");
  EXPECT_GT(a_out.messages[0]->ms_predict, 0.0f) << "the prediction took time";
  EXPECT_EQ(a_out.messages[0]->frame.bgr.size(), 160u * 120 * 3);

  const BlockGrid grid(160, 120);
  const Camera camera = rounded_for_wire(kCamera);
  const BlockMask predicted = Predictor().predict(depth_of("eyebug_a"), camera, camera, b_from_a());
  const BlockMask validated =
      Validator().validate(depth_of("eyebug_b"), camera, camera, b_from_a());
  EXPECT_GT(validated.count(), 0);
  ASSERT_EQ(prediction.messages.size(), 1u);
  const auto sent = decode_mask(prediction.messages[0]->data, grid);
  ASSERT_TRUE(sent) << sent.reason();
  EXPECT_TRUE(*sent == predicted);
  EXPECT_EQ(prediction.messages[0]->receiver, "eyebug_b");
  EXPECT_EQ(prediction.messages[0]->header.stamp, b_stamp);

  ASSERT_EQ(b_out.messages.size(), 1u);
  const rprr_msgs::OutgoingFrame& out = *b_out.messages[0];
  EXPECT_TRUE(out.sparse);
  EXPECT_EQ(out.reference, "eyebug_a");
  EXPECT_EQ(out.reference_stamp, a_stamp);
  EXPECT_EQ(out.frame.header.stamp, b_stamp);
  EXPECT_EQ(out.exchange, 7u);
  BlockMask expected = predicted;
  expected |= validated;
  const auto to_send = decode_mask(out.mask, grid);
  ASSERT_TRUE(to_send) << to_send.reason();
  EXPECT_TRUE(*to_send == expected);
  EXPECT_EQ(out.blocks_predicted, static_cast<std::uint32_t>(predicted.count()));
  EXPECT_EQ(out.blocks_validated, static_cast<std::uint32_t>(validated.count()));
  EXPECT_EQ(out.mask_bytes, ros::serialization::serializationLength(*prediction.messages[0]));
  EXPECT_EQ(out.pose_bytes, 5000u);
  EXPECT_TRUE(pose_from_fields(out.translation, out.rotation).isApprox(b_from_a()));

  EXPECT_EQ(cv::countNonZero(cv::Mat(mask.messages[0]->data)),
            cv::countNonZero(expected.to_image()));
  EXPECT_EQ(depth.messages[0]->encoding, "16UC1");
  const auto shown = decode_mask(validation.messages[0]->data, grid);
  ASSERT_TRUE(shown);
  EXPECT_TRUE(*shown == validated);
}

TEST_F(RedundancyNodes, APreviewDecidesColourAndDepthOfEveryBlock) {
  rprr_msgs::ExchangeEvent event = accepted(a_stamp, "eyebug_b", 21, a_stamp, b_stamp);
  event.peer_preview = preview_of_b();
  a.publish(event);
  b.publish(accepted(b_stamp, "eyebug_a", 21, a_stamp, b_stamp));
  ASSERT_TRUE(wait([this] {
    return !prediction.messages.empty() && !decision.messages.empty() && !points.messages.empty() &&
           !b_out.messages.empty();
  }));

  const BlockGrid grid(160, 120);
  const Camera camera = rounded_for_wire(kCamera);
  const auto preview = decode_preview(event.peer_preview);
  ASSERT_TRUE(preview) << preview.reason();
  const BlockDecision expected = Decider().decide(depth_of("eyebug_a"), colours_of("eyebug_a"),
                                                  camera, camera, b_from_a(), &*preview);
  ASSERT_TRUE(expected.from_preview);
  const auto sent = decode_mask_pair(prediction.messages[0]->data, grid);
  ASSERT_TRUE(sent) << sent.reason();
  EXPECT_TRUE(sent->colour == expected.send.colour);
  EXPECT_TRUE(sent->depth == expected.send.depth);
  const int nearer = grid.index_of_pixel(kNearer.x, kNearer.y);
  const int painted = grid.index_of_pixel(kPainted.x, kPainted.y);
  const int alike = grid.index_of_pixel(64, 64);
  EXPECT_TRUE(sent->depth[nearer]) << "b sees another surface";
  EXPECT_TRUE(sent->colour[painted] && !sent->depth[painted]) << "the same surface, painted";
  EXPECT_FALSE(sent->colour[alike] || sent->depth[alike]);

  // For people: the preview's colours, tinted.
  const sensor_msgs::Image& picture = *decision.messages[0];
  EXPECT_EQ(picture.header.stamp, b_stamp);
  EXPECT_EQ(picture.encoding, "bgr8");
  const auto shown = bgr_from_image(picture);
  ASSERT_TRUE(shown) << shown.reason();
  const cv::Mat drawn = decision_picture(*preview, expected.send);
  ASSERT_EQ(shown->size(), drawn.size());
  EXPECT_EQ(cv::norm(*shown, drawn, cv::NORM_INF), 0.0);
  const auto block_colour = [&](int block) {
    return shown->at<cv::Vec3b>(grid.rect(block).y, grid.rect(block).x);
  };
  EXPECT_GT(block_colour(nearer)[2], block_colour(alike)[2] + 50) << "red: colour and depth";
  EXPECT_GT(block_colour(painted)[0], 120) << "blue: colour only";

  const sensor_msgs::PointCloud2& cloud = *points.messages[0];
  EXPECT_EQ(cloud.header.frame_id, "eyebug_b_rprr_optical_frame");
  EXPECT_EQ(cloud.header.stamp, b_stamp);
  const std::vector<PreviewPoint> known = preview_points(*preview, camera);
  ASSERT_EQ(cloud.width * cloud.height, known.size());
  float xyz[3];
  std::memcpy(xyz, &cloud.data[cloud.point_step * 5], sizeof(xyz));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(xyz[i], known[5].position[i]);

  // b adds what it alone knows to both masks.
  const BlockMask validated =
      Validator().validate(depth_of("eyebug_b"), camera, camera, b_from_a());
  const rprr_msgs::OutgoingFrame& out = *b_out.messages[0];
  ASSERT_TRUE(out.sparse);
  const auto colour_blocks = decode_mask(out.mask, grid);
  const auto depth_blocks = decode_mask(out.depth_mask, grid);
  ASSERT_TRUE(colour_blocks && depth_blocks);
  BlockMask all_colour = expected.send.colour;
  BlockMask all_depth = expected.send.depth;
  all_colour |= validated;
  all_depth |= validated;
  EXPECT_TRUE(*colour_blocks == all_colour);
  EXPECT_TRUE(*depth_blocks == all_depth);
}

TEST_F(RedundancyNodes, SilenceOfTheReferenceSendsTheFrameWhole) {
  b.publish(accepted(b_stamp, "eyebug_a", 8, a_stamp, b_stamp));
  ASSERT_TRUE(wait([this] { return !b_out.messages.empty(); }));
  EXPECT_FALSE(b_out.messages[0]->sparse);
  EXPECT_EQ(b_out.messages[0]->frame.header.stamp, b_stamp);
}

TEST_F(RedundancyNodes, GarbageOnTheRadioSendsTheFrameWhole) {
  b.publish(accepted(b_stamp, "eyebug_a", 9, a_stamp, b_stamp));
  rprr_msgs::BlockMask garbage;
  garbage.header.stamp = b_stamp;
  garbage.receiver = "eyebug_b";
  garbage.exchange = 9;
  garbage.data.assign(300000, 0xA5);
  radio.publish(garbage);
  ASSERT_TRUE(wait([this] { return !b_out.messages.empty(); }));
  EXPECT_FALSE(b_out.messages[0]->sparse);
}

TEST_F(RedundancyNodes, BadEventsHurtNobody) {
  rprr_msgs::ExchangeEvent no_camera = accepted(a_stamp, "eyebug_b", 10, a_stamp, b_stamp);
  no_camera.peer_camera.assign(3, 0);
  a.publish(no_camera);
  rprr_msgs::ExchangeEvent no_preview = accepted(a_stamp, "eyebug_b", 10, a_stamp, b_stamp);
  no_preview.peer_preview = preview_of_b();
  no_preview.peer_preview.resize(no_preview.peer_preview.size() / 2);
  a.publish(no_preview);
  rprr_msgs::ExchangeEvent no_pose = accepted(b_stamp, "eyebug_a", 10, a_stamp, b_stamp);
  no_pose.pose.translation[0] = std::nan("");
  b.publish(no_pose);
  ASSERT_TRUE(wait([this] { return !b_out.messages.empty(); }));
  EXPECT_FALSE(b_out.messages[0]->sparse) << "no usable pose: whole";
  EXPECT_TRUE(prediction.messages.empty()) << "nothing is made of what cannot be read";
  a.publish(reference(a_stamp, "eyebug_b"));
  EXPECT_TRUE(wait([this] { return !a_out.messages.empty(); })) << "the reference goes out";
  b.publish(whole(b_stamp + ros::Duration(2), ""));
  EXPECT_TRUE(wait([this] { return b_out.messages.size() == 2; })) << "and life goes on";
}

TEST_F(RedundancyNodes, DiagnosticsNameTheRobot) {
  bool found_a = false;
  bool found_b = false;
  const auto subscriber = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const auto& status : array->status) {
          found_a = found_a || status.hardware_id == "eyebug_a";
          found_b = found_b || status.hardware_id == "eyebug_b";
        }
      });
  EXPECT_TRUE(wait([&] { return found_a && found_b; }));
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_redundancy_nodelets");
  return RUN_ALL_TESTS();
}
