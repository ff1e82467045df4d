// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/depth_frame.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rprr {
namespace {

TEST(DepthFrame, MillimetresAreTakenWithoutACopy) {
  const cv::Mat image(4, 6, CV_16UC1, cv::Scalar(1234));
  const Result<DepthFrame> frame = depth_frame_from_image(image, {0.001, 0.0002});
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->counts.data, image.data);
  EXPECT_EQ(frame->unit, 0.001);
  EXPECT_NEAR(frame->metres(3, 2), 1.234, 1e-12);
}

TEST(DepthFrame, FloatsThatAreMultiplesOfTheUnitComeBackExactly) {
  cv::Mat image(1, 65535, CV_32FC1);
  for (int i = 0; i < image.cols; ++i) {
    image.at<float>(0, i) = static_cast<float>((i + 1) * 0.0002);
  }
  const Result<DepthFrame> frame = depth_frame_from_image(image, {0.001, 0.0002});
  ASSERT_TRUE(frame);
  for (int i = 0; i < image.cols; ++i) {
    ASSERT_EQ(frame->counts.at<std::uint16_t>(0, i), i + 1);
  }
  const cv::Mat back = to_float_image(*frame);
  for (int i = 0; i < image.cols; ++i) {
    ASSERT_NEAR(back.at<float>(0, i), image.at<float>(0, i), 1e-5f * image.at<float>(0, i));
  }
}

TEST(DepthFrame, WhatIsNoDepthBecomesInvalid) {
  cv::Mat image(1, 5, CV_32FC1);
  image.at<float>(0, 0) = std::numeric_limits<float>::quiet_NaN();
  image.at<float>(0, 1) = std::numeric_limits<float>::infinity();
  image.at<float>(0, 2) = -1.0f;
  image.at<float>(0, 3) = 1e9f;
  image.at<float>(0, 4) = 0.0f;
  const Result<DepthFrame> frame = depth_frame_from_image(image, {});
  ASSERT_TRUE(frame);
  for (int i = 0; i < image.cols; ++i) EXPECT_EQ(frame->counts.at<std::uint16_t>(0, i), 0) << i;
  EXPECT_TRUE(std::isnan(to_float_image(*frame).at<float>(0, 0)));
}

TEST(DepthFrame, OtherImagesAreRefused) {
  EXPECT_FALSE(depth_frame_from_image(cv::Mat(), {}));
  EXPECT_FALSE(depth_frame_from_image(cv::Mat(2, 2, CV_8UC3), {}));
  EXPECT_FALSE(depth_frame_from_image(cv::Mat(2, 2, CV_32FC1, cv::Scalar(1)), {0.001, 0.0}));
}

TEST(DepthFrame, MillimetreImageIsTheFrameItselfOrARoundedCopy) {
  DepthFrame frame{cv::Mat(1, 1, CV_16UC1, cv::Scalar(5003)), 0.0002};
  EXPECT_EQ(to_millimetre_image(frame).at<std::uint16_t>(0, 0), 1001);
  frame.unit = 0.001;
  EXPECT_EQ(to_millimetre_image(frame).data, frame.counts.data);
}

}  // namespace
}  // namespace rprr
