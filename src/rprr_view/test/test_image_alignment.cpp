// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/image_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

namespace rprr {
namespace {

constexpr int kWidth = 157;  // no multiple of a cell
constexpr int kHeight = 118;

// Something that varies in every direction, seen `x`, `y` pixels off.
cv::Mat waves(float x, float y) {
  cv::Mat image(kHeight, kWidth, CV_32FC1);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const float p = static_cast<float>(u) + x;
      const float q = static_cast<float>(v) + y;
      image.at<float>(v, u) = 120.0f + 25.0f * std::sin(0.31f * p + 0.17f * q) +
                              25.0f * std::sin(0.23f * p - 0.37f * q) +
                              15.0f * std::sin(0.07f * p * std::cos(0.01f * q));
    }
  }
  return image;
}

cv::Mat all_valid() {
  return cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(1));
}

void add_noise(cv::Mat& image, float sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0f, sigma);
  for (int i = 0; i < static_cast<int>(image.total()); ++i) image.ptr<float>()[i] += noise(random);
}

cv::Vec2f mean_shift(const cv::Mat& shifts) {
  const cv::Scalar mean = cv::mean(shifts);
  return {static_cast<float>(mean[0]), static_cast<float>(mean[1])};
}

TEST(ImageAlignment, NothingIsShiftedWhereNothingDiffers) {
  ImageAlignment alignment;
  const cv::Mat& shifts = alignment.align(waves(0, 0), all_valid(), waves(0, 0));
  EXPECT_EQ(shifts.cols, 20);
  EXPECT_EQ(shifts.rows, 15);
  EXPECT_LT(cv::norm(shifts, cv::NORM_INF), 1e-3);
}

TEST(ImageAlignment, FindsAShiftThroughNoiseAndAnotherExposure) {
  cv::Mat base = 1.08f * waves(0.7f, -0.4f) + 9.0f;
  add_noise(base, 6.0f, 1);
  ImageAlignment alignment;
  const cv::Vec2f found = mean_shift(alignment.align(waves(0, 0), all_valid(), base));
  EXPECT_NEAR(found[0], 0.7f, 0.12f);
  EXPECT_NEAR(found[1], -0.4f, 0.12f);
}

TEST(ImageAlignment, ShiftsMayDifferFromPlaceToPlace) {
  cv::Mat base = waves(0.6f, 0.0f);
  waves(-0.6f, 0.0f)(cv::Rect(kWidth / 2, 0, kWidth - kWidth / 2, kHeight))
      .copyTo(base(cv::Rect(kWidth / 2, 0, kWidth - kWidth / 2, kHeight)));
  ImageAlignment alignment;
  const cv::Mat& shifts = alignment.align(waves(0, 0), all_valid(), base);
  EXPECT_NEAR(shifts.at<cv::Vec2f>(7, 2)[0], 0.6f, 0.15f);
  EXPECT_NEAR(shifts.at<cv::Vec2f>(7, 17)[0], -0.6f, 0.15f);
}

TEST(ImageAlignment, WhatIsNotPredictedDoesNotCount) {
  cv::Mat valid = all_valid();
  cv::Mat prediction = waves(0, 0);
  valid(cv::Rect(40, 30, 60, 50)).setTo(0);
  prediction(cv::Rect(40, 30, 60, 50)).setTo(0);
  ImageAlignment alignment;
  const cv::Vec2f found = mean_shift(alignment.align(prediction, valid, waves(0.5f, 0.5f)));
  EXPECT_NEAR(found[0], 0.5f, 0.15f) << "shifts by the hole lean towards none";
  EXPECT_NEAR(found[1], 0.5f, 0.15f);
  valid.setTo(0);
  EXPECT_LT(cv::norm(alignment.align(prediction, valid, waves(0.5f, 0.5f)), cv::NORM_INF), 1e-3);
}

TEST(ImageAlignment, FlatAndTinyImagesStayWhereTheyAre) {
  const cv::Mat flat(9, 5, CV_32FC1, cv::Scalar(100));
  cv::Mat noisy = flat.clone();
  add_noise(noisy, 3.0f, 2);
  ImageAlignment alignment;
  const cv::Mat& shifts = alignment.align(flat, cv::Mat(9, 5, CV_8UC1, cv::Scalar(1)), noisy);
  EXPECT_EQ(shifts.size(), cv::Size(1, 2));
  EXPECT_LT(cv::norm(shifts, cv::NORM_INF), 1e-3);
}

TEST(ImageAlignment, ShiftsOfARowAreInPixelsOfTheLargeImage) {
  cv::Mat shifts(2, 3, CV_32FC2, cv::Scalar(0.5, -1.0));
  std::vector<float> x(90);
  std::vector<float> y(90);
  shifts_of_row(shifts, 4, 30, 90, x.data(), y.data());
  EXPECT_FLOAT_EQ(x[0], 2.0f);
  EXPECT_FLOAT_EQ(y[89], -4.0f);
  shifts.at<cv::Vec2f>(0, 1) = {1.5f, -1.0f};
  shifts_of_row(shifts, 4, 0, 90, x.data(), y.data());
  EXPECT_FLOAT_EQ(x[0], 2.0f);
  EXPECT_NEAR(x[48], 6.0f, 0.1f) << "the middle of the second cell of 32 pixels";
}

}  // namespace
}  // namespace rprr
