// SPDX-License-Identifier: BSD-3-Clause
// What the transports put into messages, without a ROS master.
#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "rprr_ros/conversions.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"
#include "transport/colour_message.hpp"
#include "transport/depth_message.hpp"

namespace rprr {
namespace {

namespace encodings = sensor_msgs::image_encodings;
using Compressed = sensor_msgs::CompressedImage;

std_msgs::Header header() {
  std_msgs::Header header;
  header.stamp = ros::Time(12, 345);
  header.frame_id = "camera_depth_optical_frame";
  return header;
}

cv::Mat metres(int width, int height) {
  cv::Mat image = to_float_image(synthetic::kinect_like(width, height));
  image.at<float>(0, 0) = 1.0f / 3.0f;
  image.at<float>(0, 1) = std::numeric_limits<float>::infinity();
  return image;
}

bool same_message(const sensor_msgs::Image& a, const sensor_msgs::Image& b) {
  return a.header.stamp == b.header.stamp && a.header.frame_id == b.header.frame_id &&
         a.encoding == b.encoding && a.width == b.width && a.height == b.height &&
         a.step == b.step && a.data == b.data;
}

class DepthMessages : public ::testing::TestWithParam<DhcmMode> {
 protected:
  DepthMessageEncoder encoder_;
  DepthMessageDecoder decoder_{std::size_t{1} << 24};
};

TEST_P(DepthMessages, GiveBackCountsBitByBit) {
  for (const std::string& encoding : {encodings::TYPE_16UC1, encodings::MONO16}) {
    const auto image = to_image(header(), encoding, synthetic::kinect_like(164, 122).counts);
    const Result<Compressed> message = encoder_.encode(image, GetParam(), 0.01);
    ASSERT_TRUE(message) << message.reason();
    EXPECT_EQ(message->format, encoding + "; dhcm " + dhcm_mode_name(GetParam()));
    EXPECT_LT(message->data.size(), image.data.size() / 2);
    const Result<sensor_msgs::Image> back = decoder_.decode(*message);
    ASSERT_TRUE(back) << back.reason();
    EXPECT_TRUE(same_message(*back, image)) << encoding;
  }
}

TEST_P(DepthMessages, GiveBackMetresBitByBitUnlessAStepIsAskedFor) {
  const auto image = to_image(header(), encodings::TYPE_32FC1, metres(164, 122));
  const Result<Compressed> message = encoder_.encode(image, GetParam(), 0.0);
  ASSERT_TRUE(message) << message.reason();
  EXPECT_NE(message->format.find(" lossless"), std::string::npos) << message->format;
  const Result<sensor_msgs::Image> back = decoder_.decode(*message);
  ASSERT_TRUE(back) << back.reason();
  EXPECT_TRUE(same_message(*back, image));
}

TEST_P(DepthMessages, KeepMetresWithinHalfAStepAndSayTheStep) {
  const cv::Mat depth = metres(164, 122);
  const auto image = to_image(header(), encodings::TYPE_32FC1, depth);
  const Result<Compressed> message = encoder_.encode(image, GetParam(), 0.001);
  ASSERT_TRUE(message) << message.reason();
  EXPECT_NE(message->format.find(" step 0.001"), std::string::npos) << message->format;
  const Result<sensor_msgs::Image> back = decoder_.decode(*message);
  ASSERT_TRUE(back) << back.reason();
  ASSERT_EQ(back->encoding, encodings::TYPE_32FC1);
  ASSERT_EQ(back->data.size(), image.data.size());
  const auto* pixels = reinterpret_cast<const float*>(back->data.data());
  for (std::size_t i = 0; i < depth.total(); ++i) {
    const float was = depth.ptr<float>()[i];
    if (DepthTraits<float>::valid(was)) {
      ASSERT_NEAR(pixels[i], was, 0.000501) << i;
    } else {
      ASSERT_TRUE(std::isnan(pixels[i])) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllModes, DepthMessages,
                         ::testing::Values(DhcmMode::kFast, DhcmMode::kDefault, DhcmMode::kSmall),
                         [](const auto& info) { return dhcm_mode_name(info.param); });

TEST(DepthMessage, TakesPaddedRows) {
  const cv::Mat counts = synthetic::kinect_like(50, 40).counts;
  cv::Mat wide(40, 64, CV_16UC1, cv::Scalar(7));
  counts.copyTo(wide(cv::Rect(0, 0, 50, 40)));
  sensor_msgs::Image image = to_image(header(), encodings::TYPE_16UC1, wide);
  image.width = 50;  // the step stays that of 64 pixels
  const Result<Compressed> message = DepthMessageEncoder().encode(image, DhcmMode::kDefault, 0.0);
  ASSERT_TRUE(message) << message.reason();
  const Result<sensor_msgs::Image> back = DepthMessageDecoder(1 << 20).decode(*message);
  ASSERT_TRUE(back) << back.reason();
  EXPECT_TRUE(same_message(*back, to_image(header(), encodings::TYPE_16UC1, counts)));
}

TEST(DepthMessage, RefusesWhatIsNoDepth) {
  DepthMessageEncoder encoder;
  auto image = to_image(header(), encodings::BGR8, synthetic::colourful(32, 32));
  EXPECT_FALSE(encoder.encode(image, DhcmMode::kDefault, 0.0));
  for (const std::string& encoding : {encodings::TYPE_16UC1, encodings::TYPE_32FC1}) {
    image.encoding = encoding;
    image.data.resize(40);  // less than the size says
    EXPECT_FALSE(encoder.encode(image, DhcmMode::kDefault, 0.0)) << encoding;
    EXPECT_FALSE(encoder.encode(sensor_msgs::Image(), DhcmMode::kDefault, 0.0));
  }
}

TEST(DepthMessage, RefusesLargerImagesThanAllowed) {
  const auto image =
      to_image(header(), encodings::TYPE_16UC1, synthetic::kinect_like(64, 64).counts);
  const auto message = DepthMessageEncoder().encode(image, DhcmMode::kDefault, 0.0);
  ASSERT_TRUE(message);
  EXPECT_TRUE(DepthMessageDecoder(64 * 64).decode(*message));
  EXPECT_FALSE(DepthMessageDecoder(64 * 63).decode(*message));
}

// Valid messages with bytes changed, cut short, or nothing of ours at all.
template <typename Decoder>
void attack(const Compressed& good, Decoder& decoder, int attempts) {
  std::mt19937 random(11);
  for (int i = 0; i < attempts; ++i) {
    Compressed bad = good;
    if (i % 3 == 0) {
      bad.data[random() % bad.data.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    } else if (i % 3 == 1) {
      bad.data.resize(random() % bad.data.size());
    } else {
      for (auto& byte : bad.data) byte = static_cast<std::uint8_t>(random());
    }
    if (i % 2 == 0) bad.format = std::string(random() % 64, static_cast<char>(random()));
    EXPECT_FALSE(decoder.decode(bad)) << i;
    if (i % 3 == 0 && bad.data.size() > 4) {
      bad.data.resize(bad.data.size() - 4);
      seal(bad.data);             // a liar's checksum is right
      (void)decoder.decode(bad);  // an image or an error
    }
  }
}

TEST(DepthMessage, SurvivesHostileMessages) {
  const auto image =
      to_image(header(), encodings::TYPE_16UC1, synthetic::kinect_like(80, 60).counts);
  const auto message = DepthMessageEncoder().encode(image, DhcmMode::kDefault, 0.0);
  ASSERT_TRUE(message);
  DepthMessageDecoder decoder(1 << 20);
  attack(*message, decoder, 3000);
  EXPECT_TRUE(decoder.decode(*message));
}

TEST(ColourMessage, KeepsEncodingAndPixelsWithoutLoss) {
  const cv::Mat bgr = synthetic::colourful(164, 122);
  const cv::Mat grey(122, 164, CV_8UC1, cv::Scalar(77));
  ColourMessageDecoder decoder;
  decoder.set_limits({}, 1 << 20);
  ColourMessageEncoder encoder;
  for (const auto& image :
       {to_image(header(), encodings::BGR8, bgr), to_image(header(), encodings::RGB8, bgr),
        to_image(header(), encodings::MONO8, grey)}) {
    const Result<Compressed> message = encoder.encode(image, 0);
    ASSERT_TRUE(message) << message.reason();
    EXPECT_EQ(message->format, image.encoding + "; pgf lossless");
    const Result<sensor_msgs::Image> back = decoder.decode(*message);
    ASSERT_TRUE(back) << back.reason();
    EXPECT_TRUE(same_message(*back, image)) << image.encoding;
  }
}

TEST(ColourMessage, SaysItsQualityAndTakesANewOne) {
  const auto image = to_image(header(), encodings::BGR8, synthetic::colourful(164, 122));
  ColourMessageEncoder encoder;
  const auto fine = encoder.encode(image, 3);
  const auto coarse = encoder.encode(image, 12);
  ASSERT_TRUE(fine && coarse);
  EXPECT_EQ(fine->format, "bgr8; pgf quality 3");
  EXPECT_LT(coarse->data.size(), fine->data.size());
  EXPECT_FALSE(encoder.encode(image, 31));
}

TEST(ColourMessage, RefusesWhatIsNoColour) {
  ColourMessageEncoder encoder;
  const auto depth =
      to_image(header(), encodings::TYPE_16UC1, synthetic::kinect_like(64, 64).counts);
  EXPECT_FALSE(encoder.encode(depth, 6));
  auto image = to_image(header(), encodings::BGR8, synthetic::colourful(32, 32));
  image.data.resize(40);
  EXPECT_FALSE(encoder.encode(image, 6));
}

TEST(ColourMessage, SurvivesHostileMessages) {
  const auto image = to_image(header(), encodings::BGR8, synthetic::colourful(64, 48));
  const auto message = ColourMessageEncoder().encode(image, 6);
  ASSERT_TRUE(message);
  ColourMessageDecoder decoder;
  decoder.set_limits({}, 64 * 48);
  attack(*message, decoder, 200);
  EXPECT_TRUE(decoder.decode(*message));
  decoder.set_limits({}, 64 * 47);
  EXPECT_FALSE(decoder.decode(*message));
}

}  // namespace
}  // namespace rprr
