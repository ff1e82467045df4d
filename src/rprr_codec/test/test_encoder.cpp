// SPDX-License-Identifier: BSD-3-Clause
// Outgoing frames go into the encoder under test (as a nodelet or a node), and what comes out is
// decoded again.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rprr_msgs/EncodedFrame.h>
#include <rprr_msgs/OutgoingFrame.h>
#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "rprr_codec/frame_codec.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/frame_message.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

namespace encodings = sensor_msgs::image_encodings;

constexpr int kWidth = 164;
constexpr int kHeight = 122;

class Encoder : public ::testing::Test {
 protected:
  Encoder()
      : depth_(synthetic::kinect_like(kWidth, kHeight)),
        bgr_(synthetic::colourful(kWidth, kHeight)),
        mask_(synthetic::some_blocks(BlockGrid(kWidth, kHeight), 0.3)),
        motion_(exp_se3((Twist() << 0.1, 0.0, -0.05, 0.01, 0.1, 0.0).finished())),
        decoder_(make_isolated_colour_decoder()) {
    publisher_ = nh_.advertise<rprr_msgs::OutgoingFrame>("/eyebug_b/rprr/outgoing", 10);
    subscriber_ = nh_.subscribe<rprr_msgs::EncodedFrame>(
        "/eyebug_b/rprr/encoded", 10,
        [this](const rprr_msgs::EncodedFrameConstPtr& message) { received_.push_back(message); });
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
    while (publisher_.getNumSubscribers() == 0 || subscriber_.getNumPublishers() == 0) {
      if (ros::WallTime::now() > deadline) break;
      ros::WallDuration(0.02).sleep();
      ros::spinOnce();
    }
  }

  rprr_msgs::OutgoingFrame outgoing(bool sparse, double depth_unit = 0.001) const {
    RgbdFrame frame;
    frame.stamp = to_stamp(ros::Time(100, 5000));
    frame.frame_id = "eyebug_b_rgb_optical_frame";
    frame.camera = {kWidth, kHeight, 150.0, 150.0, 80.0, 60.0};
    frame.depth = {depth_.counts, depth_unit};
    frame.bgr = bgr_;
    rprr_msgs::OutgoingFrame message;
    message.frame = to_message(frame);
    message.exchange = 7;
    message.sparse = sparse ? 1 : 0;
    message.pose_bytes = 2700;
    message.mask_bytes = 300;
    message.ms_pose = 12.5f;
    message.ms_predict = 3.5f;
    if (sparse) {
      message.reference = "eyebug_a";
      message.reference_stamp = ros::Time(99, 1);
      pose_to_fields(motion_, message.translation, message.rotation);
      message.mask = message.depth_mask = encode_mask(mask_);
      message.blocks_predicted = 11;
    }
    return message;
  }
  // The next encoded frame, parsed; nothing comes within the time: null.
  rprr_msgs::EncodedFrameConstPtr next(double seconds = 10.0) {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(seconds);
    while (received_.empty() && ros::WallTime::now() < deadline) {
      ros::WallDuration(0.005).sleep();
      ros::spinOnce();
    }
    if (received_.empty()) return nullptr;
    const auto message = received_.front();
    received_.erase(received_.begin());
    return message;
  }

  // What a text option is after a request to change it.
  static std::string reconfigured(const std::string& name, const std::string& value) {
    dynamic_reconfigure::Reconfigure reconfigure;
    dynamic_reconfigure::StrParameter wanted;
    wanted.name = name;
    wanted.value = value;
    reconfigure.request.config.strs.push_back(wanted);
    if (!ros::service::call("/encoder/set_parameters", reconfigure)) return "no service";
    for (const auto& entry : reconfigure.response.config.strs) {
      if (entry.name == name) return entry.value;
    }
    return "no such option";
  }

  ros::NodeHandle nh_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  std::vector<rprr_msgs::EncodedFrameConstPtr> received_;
  DepthFrame depth_;
  cv::Mat bgr_;
  BlockMask mask_;
  Pose motion_;
  FrameDecoder decoder_;
};

TEST_F(Encoder, AWholeFrameComesOutBitByBit) {
  publisher_.publish(outgoing(false));
  const auto message = next();
  ASSERT_TRUE(message) << "nothing on /eyebug_b/rprr/encoded";
  EXPECT_EQ(message->header.stamp, ros::Time(100, 5000));
  EXPECT_EQ(message->header.frame_id, "eyebug_b_rgb_optical_frame");
  EXPECT_EQ(message->exchange, 7u);
  const Result<EncodedFrame> frame = parse_encoded_frame(message->data);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_FALSE(frame->sparse);
  EXPECT_EQ(frame->report.bytes_pose, 2700u);
  EXPECT_EQ(frame->report.bytes_masks, 300u);
  EXPECT_NEAR(frame->report.ms_predict, 3.5f, 0.1f);
  const Result<DecodedFrame> images = decoder_.decode(*frame);
  ASSERT_TRUE(images) << images.reason();
  EXPECT_TRUE(synthetic::same(images->depth.counts, depth_.counts));
  EXPECT_TRUE(synthetic::same(images->bgr, bgr_)) << "colour quality is 0, lossless";
}

TEST_F(Encoder, ASparseFrameHoldsItsBlocksAndItsMotion) {
  publisher_.publish(outgoing(true));
  const auto message = next();
  ASSERT_TRUE(message) << "nothing on /eyebug_b/rprr/encoded";
  const Result<EncodedFrame> frame = parse_encoded_frame(message->data);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_TRUE(frame->sparse);
  EXPECT_EQ(frame->reference, "eyebug_a");
  EXPECT_EQ(frame->reference_stamp, to_stamp(ros::Time(99, 1)));
  EXPECT_LT((frame->b_from_a.matrix() - motion_.matrix()).cwiseAbs().maxCoeff(), 5e-9);
  EXPECT_TRUE(frame->mask == mask_);
  EXPECT_EQ(frame->report.blocks_predicted, 11);
  EXPECT_GT(frame->report.independent_bytes_depth, frame->depth.size());
  const Result<DecodedFrame> images = decoder_.decode(*frame);
  ASSERT_TRUE(images) << images.reason();
  EXPECT_TRUE(synthetic::same(images->depth.counts, synthetic::only(depth_.counts, mask_)));
  EXPECT_TRUE(synthetic::same(synthetic::only(images->bgr, mask_), synthetic::only(bgr_, mask_)));
}

// As rqt_reconfigure does it.
TEST_F(Encoder, LiveOptionsAreDescribedAndChanged) {
  const auto description = ros::topic::waitForMessage<dynamic_reconfigure::ConfigDescription>(
      "/encoder/parameter_descriptions", ros::Duration(10.0));
  ASSERT_TRUE(description);
  ASSERT_EQ(description->groups.size(), 1u);
  std::set<std::string> names;
  for (const auto& parameter : description->groups[0].parameters) names.insert(parameter.name);
  EXPECT_EQ(names, (std::set<std::string>{"bandwidth", "colour_quality", "frame_rate", "objective",
                                          "sparse_colours"}));

  EXPECT_EQ(reconfigured("objective", "map"), "map");
  publisher_.publish(outgoing(true));
  const auto message = next();
  ASSERT_TRUE(message) << "nothing on /eyebug_b/rprr/encoded";
  const Result<EncodedFrame> frame = parse_encoded_frame(message->data);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_EQ(frame->base_reduction, 8);
  const Result<DecodedFrame> images = decoder_.decode(*frame);
  ASSERT_TRUE(images) << images.reason();
  EXPECT_EQ(images->base.size(), base_size(bgr_.size(), 8));
  EXPECT_EQ(reconfigured("objective", "fixed"), "fixed");
}

TEST_F(Encoder, LiveOptionsThatAreRefusedChangeNothing) {
  EXPECT_EQ(reconfigured("objective", "sideways"), "fixed") << "no such word";
  EXPECT_EQ(reconfigured("sparse_colours", "bytes:3000"), "quality") << "not with objective fixed";
  EXPECT_EQ(reconfigured("sparse_colours", "much"), "quality");
  publisher_.publish(outgoing(false));
  const auto message = next();
  ASSERT_TRUE(message) << "nothing on /eyebug_b/rprr/encoded";
  const Result<DecodedFrame> images = decoder_.decode(*parse_encoded_frame(message->data));
  ASSERT_TRUE(images) << images.reason();
  EXPECT_TRUE(synthetic::same(images->bgr, bgr_)) << "still lossless";
}

// The last error that a node tells on /diagnostics.
std::string told_by(const std::string& robot) {
  ros::NodeHandle nh;
  std::string text;
  const ros::Subscriber subscriber = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 50, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
        for (const auto& status : message->status) {
          if (status.hardware_id == robot && status.level == 2) text = status.message;
        }
      });
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
  while (text.empty() && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.02).sleep();
    ros::spinOnce();
  }
  return text;
}

TEST_F(Encoder, WrongParametersAreToldAllAtOnceAndKeepItFromStarting) {
  EXPECT_EQ(told_by("eyebug_c"),
            "wrong parameters: unknown parameter 'colour_qualty' (did you mean 'colour_quality'?); "
            "measure_independent: a number was given (0), allowed: true, false; receipt_timeout: "
            "-1 is not, allowed: 0 to 3600 s");
  const std::string impossible = told_by("eyebug_d");
  EXPECT_NE(impossible.find("colour_quality: quality of pgf is 40, must be 0"), std::string::npos)
      << impossible;
  ros::master::V_TopicInfo topics;
  ASSERT_TRUE(ros::master::getTopics(topics));
  for (const ros::master::TopicInfo& topic : topics) {
    EXPECT_NE(topic.name, "/eyebug_c/rprr/encoded");
    EXPECT_NE(topic.name, "/eyebug_d/rprr/encoded");
  }
}

TEST_F(Encoder, CountsKeepTheirUnit) {
  publisher_.publish(outgoing(false, 0.0002));
  const auto encoded = next();
  ASSERT_TRUE(encoded) << "nothing on /eyebug_b/rprr/encoded";
  const Result<EncodedFrame> frame = parse_encoded_frame(encoded->data);
  ASSERT_TRUE(frame) << frame.reason();
  const Result<DecodedFrame> images = decoder_.decode(*frame);
  ASSERT_TRUE(images) << images.reason();
  EXPECT_EQ(images->depth.unit, 0.0002);
  EXPECT_TRUE(synthetic::same(images->depth.counts, depth_.counts));
}

TEST_F(Encoder, UnusableFramesAreLeftOutAndTheNextOneGoesOut) {
  std::vector<rprr_msgs::OutgoingFrame> unusable(7, outgoing(true));
  unusable[0].mask.pop_back();
  unusable[1].rotation.fill(std::nan(""));
  unusable[1].translation.fill(std::nan(""));
  unusable[2].frame.depth.resize(10);
  unusable[3].frame.bgr.pop_back();
  unusable[4].frame.camera.assign(20, 0);
  unusable[5].reference.clear();
  unusable[6].frame.depth_unit = std::nan("");
  for (const auto& message : unusable) {
    publisher_.publish(message);
    EXPECT_FALSE(next(0.2)) << "an unusable frame was encoded";
  }
  publisher_.publish(outgoing(true));
  EXPECT_TRUE(next()) << "the encoder did not survive unusable frames";
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_encoder");
  return RUN_ALL_TESTS();
}
