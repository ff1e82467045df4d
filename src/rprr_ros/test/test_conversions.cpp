// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/conversions.hpp"

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

namespace rprr {
namespace {

namespace encodings = sensor_msgs::image_encodings;

TEST(Conversions, StampsGoBothWaysAndNonsenseBecomesZero) {
  const ros::Time time(1305031790, 645155000);
  EXPECT_EQ(to_time(to_stamp(time)), time);
  EXPECT_EQ(to_time(-5), ros::Time(0));
}

TEST(Conversions, SlashesOfOldBagsAreCleaned) {
  EXPECT_EQ(clean_frame("/openni_rgb_optical_frame"), "openni_rgb_optical_frame");
  EXPECT_EQ(clean_frame("eyebug_a_rgb_optical_frame"), "eyebug_a_rgb_optical_frame");
  EXPECT_EQ(clean_frame("//"), "");
}

TEST(Conversions, DepthSharesPixelsAndKeepsCounts) {
  const cv::Mat counts(4, 4, CV_16UC1, cv::Scalar(777));
  const sensor_msgs::Image message = to_depth_image({}, {counts, 0.001});
  EXPECT_EQ(message.encoding, encodings::TYPE_16UC1);
  const Result<DepthFrame> back = depth_from_image(message, {0.001, 0.0002});
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(back->counts.data, message.data.data());
  const sensor_msgs::Image fine = to_depth_image({}, {counts, 0.0002});
  EXPECT_EQ(fine.encoding, encodings::TYPE_32FC1);
  EXPECT_EQ(depth_from_image(fine, {0.001, 0.0002})->counts.at<std::uint16_t>(1, 1), 777);
}

TEST(Conversions, UnsupportedOrLyingImagesAreErrorsWithARemedy) {
  sensor_msgs::Image image = to_image({}, encodings::BGR8, cv::Mat(4, 4, CV_8UC3));
  EXPECT_NE(depth_from_image(image, {}).reason().find("16UC1"), std::string::npos);
  EXPECT_TRUE(bgr_from_image(image));
  image.width = 4000;  // says more than it holds
  EXPECT_FALSE(bgr_from_image(image));
  image = to_image({}, encodings::TYPE_32FC1, cv::Mat(4, 4, CV_32FC1));
  EXPECT_NE(bgr_from_image(image).reason().find("bgr8"), std::string::npos);
  image.encoding = "no such encoding";
  EXPECT_FALSE(bgr_from_image(image));
  EXPECT_FALSE(depth_from_image(image, {}));
  EXPECT_FALSE(bgr_from_image(sensor_msgs::Image()));
}

TEST(Conversions, RgbBecomesBgr) {
  const sensor_msgs::Image image =
      to_image({}, encodings::RGB8, cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3)));
  EXPECT_EQ(bgr_from_image(image)->at<cv::Vec3b>(0, 0), cv::Vec3b(3, 2, 1));
}

TEST(Conversions, PoseFieldsRoundTrip) {
  Twist twist;
  twist << 0.1, -0.2, 0.3, 0.2, 0.1, -0.4;
  const Pose pose = exp_se3(twist);
  boost::array<double, 3> translation;
  boost::array<double, 4> rotation;
  pose_to_fields(pose, translation, rotation);
  EXPECT_LT((pose_from_fields(translation, rotation).matrix() - pose.matrix()).norm(), 1e-12);
}

}  // namespace
}  // namespace rprr
