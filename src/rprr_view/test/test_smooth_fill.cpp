// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/smooth_fill.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace rprr {
namespace {

TEST(SmoothFill, KnownPixelsAreNotTouchedAndConstantsSpread) {
  cv::Mat bgr(45, 61, CV_8UC3, cv::Scalar(10, 20, 30));
  cv::Mat known(bgr.size(), CV_8UC1, cv::Scalar(255));
  known(cv::Rect(5, 5, 40, 30)).setTo(0);
  bgr(cv::Rect(5, 5, 40, 30)).setTo(cv::Scalar(200, 200, 200));
  SmoothFiller().fill(bgr, known);
  EXPECT_EQ(cv::norm(bgr, cv::Mat(bgr.size(), CV_8UC3, cv::Scalar(10, 20, 30)), cv::NORM_INF), 0);
}

TEST(SmoothFill, StaysBetweenItsNeighbours) {
  cv::Mat bgr(48, 64, CV_8UC3, cv::Scalar::all(0));
  cv::Mat known(bgr.size(), CV_8UC1, cv::Scalar(0));
  bgr(cv::Rect(0, 0, 10, 48)).setTo(cv::Scalar::all(50));
  bgr(cv::Rect(54, 0, 10, 48)).setTo(cv::Scalar::all(150));
  known(cv::Rect(0, 0, 10, 48)).setTo(1);
  known(cv::Rect(54, 0, 10, 48)).setTo(1);
  SmoothFiller().fill(bgr, known);
  double least = 0;
  double most = 0;
  cv::minMaxLoc(bgr.reshape(1), &least, &most);
  EXPECT_GE(least, 49);
  EXPECT_LE(most, 151);
  EXPECT_LT(bgr.at<cv::Vec3b>(24, 14)[0], 100);
  EXPECT_GT(bgr.at<cv::Vec3b>(24, 50)[0], 100);
}

TEST(SmoothFill, OnePixelIsEnoughAndNoneIsGrey) {
  cv::Mat bgr(33, 47, CV_8UC3, cv::Scalar::all(0));
  cv::Mat known(bgr.size(), CV_8UC1, cv::Scalar(0));
  SmoothFiller filler;
  filler.fill(bgr, known);
  EXPECT_EQ(bgr.at<cv::Vec3b>(3, 3), cv::Vec3b(128, 128, 128));
  bgr.at<cv::Vec3b>(30, 40) = {7, 8, 9};
  known.at<std::uint8_t>(30, 40) = 1;
  filler.fill(bgr, known);
  EXPECT_EQ(cv::norm(bgr, cv::Mat(bgr.size(), CV_8UC3, cv::Scalar(7, 8, 9)), cv::NORM_INF), 0);
  cv::Mat one(1, 1, CV_8UC3, cv::Scalar::all(5));
  filler.fill(one, cv::Mat(1, 1, CV_8UC1, cv::Scalar(1)));
  EXPECT_EQ(one.at<cv::Vec3b>(0, 0)[0], 5);
}

}  // namespace
}  // namespace rprr
