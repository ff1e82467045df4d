// SPDX-License-Identifier: BSD-3-Clause
// Plays two robots' cameras and the pose exchange; Prediction of eyebug_a and Validation of
// eyebug_b are started by the .test files, as nodelets and as nodes.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/OutgoingFrame.h>
#include <sensor_msgs/image_encodings.h>

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "rprr_geometry_ros/conversions.hpp"
#include "rprr_redundancy/outgoing.hpp"
#include "rprr_redundancy/prediction.hpp"
#include "rprr_redundancy/validation.hpp"

namespace rprr {
namespace {

const Camera kCamera{160, 120, 140, 140, 79.5, 59.5};

DepthFrame depth_of(const std::string& robot) {
  DepthFrame frame{cv::Mat(120, 160, CV_16UC1, cv::Scalar(2000)), 0.001};
  if (robot == "eyebug_b") frame.counts(cv::Rect(0, 40, 16, 16)).setTo(500);
  return frame;
}

Pose m_ab() {
  Pose pose = Pose::Identity();
  pose.translation().x() = 0.3;
  return pose;
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
        rgb_(nh.advertise<sensor_msgs::Image>("/" + name + "/camera/rgb/image_rect_color", 5)),
        info_(nh.advertise<sensor_msgs::CameraInfo>("/" + name + "/camera/rgb/camera_info", 5)),
        depth_(nh.advertise<sensor_msgs::Image>("/" + name + "/camera/depth_registered/image_rect",
                                                5)),
        events_(nh.advertise<rprr_msgs::ExchangeEvent>("/" + name + "/rprr/exchange", 5)) {}

  bool connected() const {
    return rgb_.getNumSubscribers() > 0 && info_.getNumSubscribers() > 0 &&
           depth_.getNumSubscribers() > 0 && events_.getNumSubscribers() > 0;
  }
  void show(ros::Time stamp) {
    std_msgs::Header header;
    header.stamp = stamp;
    header.frame_id = "/" + optical_frame(name_);
    info_.publish(info_from_camera(kCamera, header));
    ros::Duration(0.05).sleep();  // info comes over another connection
    rgb_.publish(to_image(header, "bgr8", cv::Mat(120, 160, CV_8UC3, cv::Scalar(1, 2, 3))));
    depth_.publish(to_depth_image(header, depth_of(name_)));
  }
  void publish(const rprr_msgs::ExchangeEvent& event) { events_.publish(event); }

 private:
  std::string name_;
  ros::Publisher rgb_, info_, depth_, events_;
};

rprr_msgs::ExchangeEvent whole(ros::Time stamp, const std::string& peer) {
  rprr_msgs::ExchangeEvent event;
  event.header.stamp = stamp;
  event.action = rprr_msgs::ExchangeEvent::SEND_WHOLE;
  event.peer = peer;
  event.reason = "a test";
  return event;
}

rprr_msgs::ExchangeEvent sparse(ros::Time stamp, const std::string& peer, std::uint32_t exchange,
                                ros::Time a_stamp, ros::Time b_stamp) {
  rprr_msgs::ExchangeEvent event = whole(stamp, peer);
  event.action = rprr_msgs::ExchangeEvent::SEND_SPARSE;
  event.exchange = exchange;
  event.pose.status = rprr_msgs::RelativePose::ACCEPTED;
  event.pose.header.stamp = a_stamp;
  event.pose.dependent_stamp = b_stamp;
  event.pose.dependent = "eyebug_b";
  event.exchange_bytes = 5000;
  pose_to_fields(m_ab(), event.pose.translation, event.pose.rotation);
  ByteWriter writer;
  put_camera(writer, kCamera);
  event.peer_camera = writer.take();
  return event;
}

class Redundancy : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wait([this] {
      return a.connected() && b.connected() && a_out.connected() && b_out.connected() &&
             prediction.connected() && mask.connected() && validation.connected() &&
             radio.getNumSubscribers() > 0;
    })) << "the nodelets do not listen on the fixed topics";
    a_stamp = ros::Time(1000 + 10 * ++tests, 123456789);
    b_stamp = a_stamp + ros::Duration(1);
    a.show(a_stamp);
    b.show(b_stamp);
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
  Inbox<rprr_msgs::BlockMask> validation{nh, "/eyebug_b/rprr/validation"};
  Inbox<sensor_msgs::Image> mask{nh, "/eyebug_b/rprr/mask"};
  Inbox<sensor_msgs::Image> rgb{nh, "/eyebug_b/rprr/sparse/rgb"};
  Inbox<sensor_msgs::Image> depth{nh, "/eyebug_b/rprr/sparse/depth"};
  ros::Time a_stamp;
  ros::Time b_stamp;
};
int Redundancy::tests = 0;

TEST_F(Redundancy, AnExchangeFromEventsToOutgoingFrames) {
  a.publish(whole(a_stamp, "eyebug_b"));
  a.publish(whole(a_stamp, "eyebug_c"));  // another dependent, the same reference frame
  a.publish(sparse(a_stamp, "eyebug_b", 7, a_stamp, b_stamp));
  b.publish(sparse(b_stamp, "eyebug_a", 7, a_stamp, b_stamp));
  ASSERT_TRUE(wait([this] {
    return !a_out.messages.empty() && !b_out.messages.empty() && !mask.messages.empty() &&
           !rgb.messages.empty() && !depth.messages.empty() && !validation.messages.empty();
  }));
  wait([] { return false; }, 0.3);

  ASSERT_EQ(a_out.messages.size(), 1u) << "a reference frame goes out once";
  EXPECT_FALSE(a_out.messages[0]->sparse);
  EXPECT_EQ(a_out.messages[0]->header.stamp, a_stamp);
  EXPECT_EQ(a_out.messages[0]->header.frame_id, "eyebug_a_rgb_optical_frame") << "slash cleaned";
  EXPECT_EQ(a_out.messages[0]->rgb.data.size(), 160u * 120 * 3);

  const BlockGrid grid(160, 120);
  const Camera camera = rounded_for_wire(kCamera);
  const BlockMask predicted = Predictor().predict(depth_of("eyebug_a"), camera, camera, m_ab());
  const BlockMask validated = Validator().validate(depth_of("eyebug_b"), camera, camera, m_ab());
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
  EXPECT_EQ(out.header.stamp, b_stamp);
  EXPECT_EQ(out.exchange, 7u);
  BlockMask expected = predicted;
  expected |= validated;
  const auto to_send = decode_mask(out.mask, grid);
  ASSERT_TRUE(to_send) << to_send.reason();
  EXPECT_TRUE(*to_send == expected);
  EXPECT_EQ(out.blocks_predicted, static_cast<std::uint32_t>(predicted.count()));
  EXPECT_EQ(out.blocks_validated, static_cast<std::uint32_t>(validated.count()));
  EXPECT_EQ(out.mask_bytes, ros::serialization::serializationLength(*prediction.messages[0]));
  EXPECT_EQ(out.exchange_bytes, 5000 + out.mask_bytes);
  EXPECT_TRUE(pose_from_fields(out.translation, out.rotation).isApprox(m_ab()));

  EXPECT_EQ(cv::countNonZero(cv::Mat(mask.messages[0]->data)),
            cv::countNonZero(expected.to_image()));
  EXPECT_EQ(depth.messages[0]->encoding, "16UC1");
  const auto shown = decode_mask(validation.messages[0]->data, grid);
  ASSERT_TRUE(shown);
  EXPECT_TRUE(*shown == validated);
}

TEST_F(Redundancy, SilenceOfTheReferenceSendsTheFrameWhole) {
  b.publish(sparse(b_stamp, "eyebug_a", 8, a_stamp, b_stamp));
  ASSERT_TRUE(wait([this] { return !b_out.messages.empty(); }));
  EXPECT_FALSE(b_out.messages[0]->sparse);
  EXPECT_EQ(b_out.messages[0]->header.stamp, b_stamp);
}

TEST_F(Redundancy, GarbageOnTheRadioSendsTheFrameWhole) {
  b.publish(sparse(b_stamp, "eyebug_a", 9, a_stamp, b_stamp));
  rprr_msgs::BlockMask garbage;
  garbage.header.stamp = b_stamp;
  garbage.receiver = "eyebug_b";
  garbage.exchange = 9;
  garbage.data.assign(300000, 0xA5);
  radio.publish(garbage);
  ASSERT_TRUE(wait([this] { return !b_out.messages.empty(); }));
  EXPECT_FALSE(b_out.messages[0]->sparse);
}

TEST_F(Redundancy, BadEventsHurtNobody) {
  rprr_msgs::ExchangeEvent no_camera = sparse(a_stamp, "eyebug_b", 10, a_stamp, b_stamp);
  no_camera.peer_camera.assign(3, 0);
  a.publish(no_camera);
  rprr_msgs::ExchangeEvent no_pose = sparse(b_stamp, "eyebug_a", 10, a_stamp, b_stamp);
  no_pose.pose.translation[0] = std::nan("");
  b.publish(no_pose);
  b.publish(sparse(b_stamp + ros::Duration(100), "eyebug_a", 11, a_stamp, b_stamp));  // no frame
  ASSERT_TRUE(wait([this] { return !b_out.messages.empty(); }));
  EXPECT_FALSE(b_out.messages[0]->sparse) << "no usable pose: whole";
  EXPECT_TRUE(wait([this] { return !a_out.messages.empty(); })) << "the reference goes out";
  const ros::Time later = b_stamp + ros::Duration(2);
  b.show(later);
  b.publish(whole(later, ""));
  EXPECT_TRUE(wait([this] { return b_out.messages.size() == 2; })) << "and life goes on";
}

TEST_F(Redundancy, DiagnosticsNameTheRobot) {
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
