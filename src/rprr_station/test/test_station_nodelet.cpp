// SPDX-License-Identifier: BSD-3-Clause
// Two robots send encoded frames; the station is started by the .test files, as nodelet and as
// node.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rprr_msgs/EncodedFrame.h>
#include <rprr_msgs/PairStatistics.h>
#include <rprr_msgs/Receipt.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_view/provenance.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

const Camera kCamera{160, 120, 140, 140, 79.5, 59.5};

DepthFrame plane(int millimetres) {
  return {cv::Mat(120, 160, CV_16UC1, cv::Scalar(millimetres)), 0.001};
}

cv::Mat colour(int blue) {
  return cv::Mat(120, 160, CV_8UC3, cv::Scalar(blue, 100, 150));
}

EncodedFrame encode(EncodedFrame frame, const DepthFrame& depth, const cv::Mat& bgr) {
  frame.camera = kCamera;
  FrameCodecOptions options;
  options.colour_codec = "pgf";
  options.colour_quality = 0;
  options.objective = Objective::kFixed;
  auto encoder = FrameEncoder::create(options);
  EXPECT_TRUE(encoder) << encoder.reason();
  const auto done = encoder->encode(depth, bgr, frame);
  EXPECT_TRUE(done) << done.reason();
  return frame;
}

EncodedFrame sparse(const std::string& reference, ros::Time stamp) {
  EncodedFrame frame;
  frame.sparse = true;
  frame.reference = reference;
  frame.reference_stamp = to_stamp(stamp);
  frame.mask = BlockMask(BlockGrid(160, 120));
  frame.mask.set(0);
  frame.mask.set(21);
  return encode(frame, plane(1500), colour(200));
}

template <typename T>
class Inbox {
 public:
  Inbox(ros::NodeHandle& nh, const std::string& topic)
      : subscriber_(nh.subscribe(topic, 50, &Inbox::receive, this)) {}
  std::vector<typename T::ConstPtr> messages;
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  void receive(const typename T::ConstPtr& message) { messages.push_back(message); }
  ros::Subscriber subscriber_;
};

class StationNodelet : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wait([this] {
      return a.getNumSubscribers() > 0 && b.getNumSubscribers() > 0 && rgb.connected() &&
             info.connected() && depth.connected() && points.connected() && scene.connected() &&
             provenance.connected() && frusta.connected() && statistics.connected() &&
             receipts.connected();
    })) << "the station does not use the fixed topics";
    stamp = ros::Time(1000 + 10 * ++tests, 5000);
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
  static void send(ros::Publisher& robot, ros::Time at, const std::string& frame_id,
                   const Bytes& bytes) {
    rprr_msgs::EncodedFrame message;
    message.header.stamp = at;
    message.header.frame_id = frame_id;
    message.exchange = 4;
    message.data = bytes;
    robot.publish(message);
  }
  const rprr_msgs::PairStatistics* statistics_of(const std::string& robot) const {
    for (const auto& message : statistics.messages) {
      if (message->robot == robot) return message.get();
    }
    return nullptr;
  }

  static int tests;
  ros::NodeHandle nh;
  ros::Publisher a = nh.advertise<rprr_msgs::EncodedFrame>("/eyebug_a/rprr/encoded", 50);
  ros::Publisher b = nh.advertise<rprr_msgs::EncodedFrame>("/eyebug_b/rprr/encoded", 50);
  Inbox<sensor_msgs::Image> rgb_a{nh, "/station/eyebug_a/rgb/image_rect_color"};
  Inbox<sensor_msgs::Image> rgb{nh, "/station/eyebug_b/rgb/image_rect_color"};
  Inbox<sensor_msgs::CameraInfo> info{nh, "/station/eyebug_b/rgb/camera_info"};
  Inbox<sensor_msgs::Image> depth{nh, "/station/eyebug_b/depth_registered/image_rect"};
  Inbox<sensor_msgs::PointCloud2> points{nh, "/station/eyebug_b/points"};
  Inbox<sensor_msgs::PointCloud2> scene{nh, "/station/points"};
  Inbox<sensor_msgs::Image> provenance{nh, "/station/eyebug_b/provenance"};
  Inbox<visualization_msgs::MarkerArray> frusta{nh, "/station/frusta"};
  Inbox<rprr_msgs::PairStatistics> statistics{nh, "/station/statistics"};
  bool receipt(const std::function<bool(const rprr_msgs::Receipt&)>& wanted) const {
    return std::any_of(receipts.messages.begin(), receipts.messages.end(),
                       [&](const auto& message) { return wanted(*message); });
  }
  bool holds(const std::string& robot, ros::Time at) const {
    return receipt([&](const rprr_msgs::Receipt& receipt) {
      return receipt.robot == robot && !receipt.held.empty() && receipt.held.back() == at &&
             receipt.last == at;
    });
  }
  Inbox<rprr_msgs::Receipt> receipts{nh, "/station/receipts"};
  ros::Time stamp;
};
int StationNodelet::tests = 0;

TEST_F(StationNodelet, WholeAndSparseFrameToViews) {
  const Bytes whole_bytes = serialise(encode({}, plane(2000), colour(10)));
  const Bytes sparse_bytes = serialise(sparse("eyebug_a", stamp));
  send(a, stamp, "/eyebug_a_rgb_optical_frame", whole_bytes);
  send(b, stamp + ros::Duration(1), "eyebug_b_rgb_optical_frame", sparse_bytes);
  ASSERT_TRUE(wait([this] {
    return !rgb_a.messages.empty() && !rgb.messages.empty() && !depth.messages.empty() &&
           !points.messages.empty() && !scene.messages.empty() && !provenance.messages.empty() &&
           !info.messages.empty() && statistics_of("eyebug_a") != nullptr &&
           statistics_of("eyebug_b") != nullptr && holds("eyebug_a", stamp) &&
           frusta.messages.size() >= 2;
  }));
  EXPECT_EQ(rgb_a.messages[0]->header.frame_id, "eyebug_a_rgb_optical_frame");
  EXPECT_EQ(rgb.messages[0]->header.frame_id, "eyebug_b_rprr_optical_frame");
  EXPECT_EQ(rgb.messages[0]->header.stamp, stamp + ros::Duration(1));
  EXPECT_EQ(info.messages[0]->width, 160u);

  const auto bgr = bgr_from_image(*rgb.messages[0]);
  ASSERT_TRUE(bgr) << bgr.reason();
  EXPECT_EQ(bgr->at<cv::Vec3b>(100, 100), cv::Vec3b(10, 100, 150)) << "predicted";
  EXPECT_EQ(bgr->at<cv::Vec3b>(2, 2), cv::Vec3b(200, 100, 150)) << "received";
  EXPECT_EQ(depth.messages[0]->encoding, "16UC1");
  const auto counts = depth_from_image(*depth.messages[0], {});
  ASSERT_TRUE(counts) << counts.reason();
  EXPECT_EQ(counts->counts.at<std::uint16_t>(100, 100), 2000);
  EXPECT_EQ(counts->counts.at<std::uint16_t>(2, 2), 1500);
  EXPECT_EQ(provenance.messages[0]->data[100 * 160 + 100], kPredicted);
  EXPECT_EQ(provenance.messages[0]->data[0], kReceived);

  const sensor_msgs::PointCloud2& cloud = *points.messages[0];
  ASSERT_EQ(cloud.data.size(), 160u * 120 * 16);
  float xyz[3];
  std::memcpy(xyz, &cloud.data[(100 * 160 + 100) * 16], sizeof(xyz));
  EXPECT_NEAR(xyz[0], (100 - 79.5) / 140 * 2, 1e-4);
  EXPECT_NEAR(xyz[2], 2.0, 1e-4);

  EXPECT_EQ(scene.messages[0]->header.frame_id, "eyebug_a_rgb_optical_frame");
  EXPECT_EQ(scene.messages[0]->header.stamp, stamp) << "the reference's";
  EXPECT_EQ(scene.messages[0]->width, 160u * 120 + 2 * 64)
      << "all of a's points, b's own two blocks";

  ASSERT_EQ(frusta.messages[1]->markers.size(), 1u);
  const visualization_msgs::Marker& of_a = frusta.messages[0]->markers[0];
  const visualization_msgs::Marker& frustum = frusta.messages[1]->markers[0];
  EXPECT_EQ(of_a.ns, "eyebug_a");
  EXPECT_EQ(of_a.header.frame_id, "eyebug_a_rgb_optical_frame");
  EXPECT_EQ(frustum.ns, "eyebug_b");
  EXPECT_EQ(frustum.header.frame_id, "eyebug_b_rprr_optical_frame");
  EXPECT_EQ(frustum.header.stamp, stamp + ros::Duration(1));
  EXPECT_EQ(frustum.points.size() % 2, 0u);
  EXPECT_FALSE(frustum.points.empty());
  EXPECT_NE(frustum.color.r, of_a.color.r) << "robots are told apart";

  const rprr_msgs::PairStatistics& of_b = *statistics_of("eyebug_b");
  EXPECT_EQ(of_b.reference, "eyebug_a");
  EXPECT_EQ(of_b.reference_stamp, stamp);
  EXPECT_EQ(of_b.exchange, 4u);
  EXPECT_EQ(of_b.blocks_total, 300u);
  EXPECT_EQ(of_b.blocks_sent, 2u);
  rprr_msgs::EncodedFrame message;
  message.header.frame_id = "eyebug_b_rgb_optical_frame";
  message.data = sparse_bytes;
  EXPECT_EQ(of_b.bytes_total, ros::serialization::serializationLength(message));
  EXPECT_EQ(of_b.bytes_total, of_b.bytes_pose + of_b.bytes_masks + of_b.bytes_depth +
                                  of_b.bytes_colour + of_b.bytes_extras);
  EXPECT_EQ(statistics_of("eyebug_a")->blocks_sent, 300u);
}

TEST_F(StationNodelet, RobotsHearEverySecondThatTheStationIsThere) {
  receipts.messages.clear();
  EXPECT_TRUE(wait([this] {
    return receipt([](const auto& receipt) { return receipt.robot == "eyebug_a"; }) &&
           receipt([](const auto& receipt) { return receipt.robot == "eyebug_b"; });
  }));
}

TEST_F(StationNodelet, MissingReferenceIsAskedFor) {
  send(b, stamp, "", serialise(sparse("eyebug_a", stamp)));
  EXPECT_TRUE(wait([this] {
    return receipt([this](const rprr_msgs::Receipt& receipt) {
      return receipt.robot == "eyebug_a" && receipt.repeat == std::vector<ros::Time>{stamp};
    });
  }));
  EXPECT_TRUE(receipt([this](const rprr_msgs::Receipt& receipt) {
    return receipt.robot == "eyebug_b" && receipt.last == stamp;
  })) << "b is told that its frame came, whatever becomes of it";
  EXPECT_TRUE(rgb.messages.empty());
}

TEST_F(StationNodelet, GarbageOnTheRadioHurtsNobody) {
  std::mt19937 random(4);
  EncodedFrame hostile = encode({}, plane(2000), colour(10));
  hostile.colour.resize(hostile.colour.size() - 4);
  for (std::size_t i = hostile.colour.size() / 2; i < hostile.colour.size(); ++i) {
    hostile.colour[i] = static_cast<std::uint8_t>(random());
  }
  seal(hostile.colour);  // checksums find accidents, not attacks
  send(a, stamp, "", serialise(hostile));
  Bytes noise(5000);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
  seal(noise);
  send(a, stamp, "", noise);
  send(a, stamp, "", {});
  bool complained = false;
  const auto subscriber = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const auto& status : array->status) {
          const bool ours = status.message.find("/eyebug_a/rprr/encoded") != std::string::npos;
          complained = complained || (ours && status.level > 0);
        }
      });
  EXPECT_TRUE(wait([&] { return complained; })) << "diagnostics name the topic";
  const ros::Time later = stamp + ros::Duration(1);
  send(a, later, "", serialise(encode({}, plane(2000), colour(10))));
  EXPECT_TRUE(wait([&] {
    return !rgb_a.messages.empty() && rgb_a.messages.back()->header.stamp == later;
  })) << "and life goes on";
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_station_nodelet");
  return RUN_ALL_TESTS();
}
