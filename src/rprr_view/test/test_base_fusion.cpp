// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/base_fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

namespace rprr {
namespace {

// Smooth shapes with fine texture.
cv::Mat scene(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  std::mt19937 random(11);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double broad = 60.0 * std::sin(0.021 * u + 0.013 * v) + 40.0 * std::sin(0.05 * v);
      const double fine = 18.0 * std::sin(1.1 * u) * std::sin(0.9 * v);
      for (int i = 0; i < 3; ++i) {
        image.at<cv::Vec3b>(v, u)[i] =
            cv::saturate_cast<std::uint8_t>(120.0 + (i + 1) * 0.4 * broad + fine);
      }
    }
  }
  return image;
}

cv::Mat with_noise(const cv::Mat& image, double sigma, unsigned seed) {
  cv::Mat out = image.clone();
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma);
  for (int v = 0; v < out.rows; ++v) {
    auto* row = out.ptr<std::uint8_t>(v);
    for (int i = 0; i < 3 * out.cols; ++i) {
      row[i] = cv::saturate_cast<std::uint8_t>(row[i] + noise(random));
    }
  }
  return out;
}

// As codecs leave it at full size: little of it in the finest octave.
cv::Mat with_broad_noise(const cv::Mat& image, double sigma, unsigned seed) {
  const cv::Size half((image.cols + 1) / 2, (image.rows + 1) / 2);
  const cv::Mat noise = with_noise(cv::Mat(half, CV_8UC3, cv::Scalar::all(128)), sigma, seed);
  cv::Mat out = image.clone();
  for (int v = 0; v < out.rows; ++v) {
    for (int i = 0; i < 3 * out.cols; ++i) {
      const int from = noise.ptr<std::uint8_t>(v / 2)[i / 3 / 2 * 3 + i % 3];
      auto& value = out.ptr<std::uint8_t>(v)[i];
      value = cv::saturate_cast<std::uint8_t>(value + from - 128);
    }
  }
  return out;
}

cv::Mat reduced(const cv::Mat& image, int side) {
  cv::Mat out((image.rows + side - 1) / side, (image.cols + side - 1) / side, CV_8UC3);
  for (int v = 0; v < out.rows; ++v) {
    for (int u = 0; u < out.cols; ++u) {
      const cv::Rect cell =
          cv::Rect(u * side, v * side, side, side) & cv::Rect(0, 0, image.cols, image.rows);
      const cv::Scalar mean = cv::mean(image(cell));
      for (int i = 0; i < 3; ++i) {
        out.at<cv::Vec3b>(v, u)[i] = cv::saturate_cast<std::uint8_t>(mean[i]);
      }
    }
  }
  return out;
}

PredictedView predicted(const cv::Mat& bgr) {
  PredictedView view;
  view.bgr = bgr.clone();
  view.metres = cv::Mat(bgr.size(), CV_32FC1, cv::Scalar(2.0));
  view.provenance = cv::Mat(bgr.size(), CV_8UC1, cv::Scalar(kPredicted));
  return view;
}

double rms(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L2) / std::sqrt(3.0 * static_cast<double>(a.total()));
}

class AtEveryReduction : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Reductions, AtEveryReduction, testing::Values(1, 2, 4, 8, 16));

// A prediction that is right stays, however noisy the base is.
TEST_P(AtEveryReduction, AGoodPredictionIsNotSpoilt) {
  const cv::Mat truth = scene(187, 141);
  PredictedView view = predicted(truth);
  const double sigma = 9.0;
  const cv::Mat small = reduced(truth, GetParam());
  const BaseImage base{
      GetParam() == 1 ? with_broad_noise(small, sigma, 5) : with_noise(small, sigma, 5), GetParam(),
      static_cast<float>(sigma)};
  ASSERT_TRUE(base.fits(truth.size()));
  BaseFusion().fuse(base, view);
  EXPECT_LT(rms(view.bgr, truth), 0.5 * sigma);
}

// Another exposure of the prediction is corrected, its texture kept.
TEST_P(AtEveryReduction, LightComesFromTheBaseAndDetailFromThePrediction) {
  const cv::Mat truth = scene(187, 141);
  cv::Mat darker;
  truth.convertTo(darker, CV_8U, 0.8, 6.0);
  PredictedView view = predicted(darker);
  const BaseImage base{with_noise(reduced(truth, GetParam()), 2.0, 5), GetParam(), 2.0f};
  const double before = rms(darker, truth);
  BaseFusion().fuse(base, view);
  EXPECT_LT(rms(view.bgr, truth), 0.4 * before) << "before: " << before;
}

// Where the prediction shows something else than the base, the base wins.
TEST_P(AtEveryReduction, AWrongPredictionGivesWay) {
  const cv::Mat truth = scene(192, 144);
  cv::Mat wrong = truth.clone();
  const cv::Rect patch(64, 48, 64, 48);
  cv::Mat(truth(cv::Rect(0, 80, 64, 48))).copyTo(wrong(patch));
  wrong(patch) = cv::Scalar(255, 255, 255) - wrong(patch);
  PredictedView view = predicted(wrong);
  const BaseImage base{with_noise(reduced(truth, GetParam()), 3.0, 5), GetParam(), 3.0f};
  BaseFusion().fuse(base, view);
  const double before = rms(wrong(patch), truth(patch));
  EXPECT_LT(rms(view.bgr(patch), truth(patch)), (GetParam() <= 4 ? 0.3 : 0.5) * before)
      << "before: " << before;
}

TEST_P(AtEveryReduction, WhatIsNotPredictedIsTheBase) {
  const cv::Mat truth = scene(133, 97);
  PredictedView view = predicted(truth);
  const cv::Rect hole(40, 30, 48, 40);
  view.bgr(hole).setTo(0);
  view.provenance(hole).setTo(kNothing);
  const BaseImage base{reduced(truth, GetParam()), GetParam(), 0.5f};
  BaseFusion().fuse(base, view);
  EXPECT_EQ(cv::countNonZero(view.provenance(hole) != kBase), 0);
  EXPECT_EQ(cv::countNonZero(view.provenance == kNothing), 0);
  EXPECT_LT(rms(view.bgr(hole), truth(hole)), GetParam() == 1 ? 1.0 : 16.0);
}

// Neither source alone does as well as both.
TEST(BaseFusion, TheJointEstimateBeatsBoth) {
  const cv::Mat truth = scene(256, 192);
  cv::Mat shaded = with_noise(truth, 3.0, 8);
  for (int v = 0; v < shaded.rows; ++v) shaded.row(v) += cv::Scalar::all(20.0 * v / shaded.rows);
  for (const int reduction : {1, 2}) {
    PredictedView view = predicted(shaded);
    const BaseImage base{with_noise(reduced(truth, reduction), 8.0, 6), reduction, 8.0f};
    BaseFusion().fuse(base, view);
    EXPECT_LT(rms(view.bgr, truth), 0.6 * rms(shaded, truth)) << reduction;
    EXPECT_LT(rms(view.bgr, truth), 7.0) << reduction;
  }
}

TEST(BaseFusion, AFineBaseOfFullSizeIsTheView) {
  const cv::Mat truth = scene(100, 80);
  const cv::Mat sent = with_noise(truth, 2.0, 3);
  PredictedView view = predicted(with_noise(truth, 1.0, 4));
  BaseFusion().fuse({sent, 1, 2.0f}, view);
  EXPECT_EQ(cv::norm(view.bgr, sent, cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(view.provenance != kBase), 0);
}

TEST(BaseFusion, SmallAndOddImages) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(17, 9), cv::Size(640, 8)}) {
    for (const int reduction : {1, 2, 16}) {
      const cv::Mat grey(size, CV_8UC3, cv::Scalar(10, 200, 90));
      PredictedView view = predicted(cv::Mat(size, CV_8UC3, cv::Scalar(50, 50, 50)));
      const BaseImage base{reduced(grey, reduction), reduction, 1.0f};
      ASSERT_TRUE(base.fits(size));
      BaseFusion().fuse(base, view);
      EXPECT_LE(cv::norm(view.bgr, grey, cv::NORM_INF), 1) << size << " / " << reduction;
    }
  }
}

TEST(BaseImage, FitsOnlyItsFrame) {
  const cv::Mat bgr(8, 10, CV_8UC3);
  EXPECT_TRUE((BaseImage{bgr, 16, 5.0f}.fits({160, 128})));
  EXPECT_TRUE((BaseImage{bgr, 16, 5.0f}.fits({145, 113})));
  EXPECT_FALSE((BaseImage{bgr, 16, 5.0f}.fits({161, 128})));
  EXPECT_FALSE((BaseImage{bgr, 3, 5.0f}.fits({30, 24})));
  EXPECT_FALSE((BaseImage{bgr, 1, 0.0f}.fits({10, 8})));
  EXPECT_FALSE((BaseImage{bgr, 1, NAN}.fits({10, 8})));
  EXPECT_FALSE((BaseImage{cv::Mat(8, 10, CV_8UC1), 1, 5.0f}.fits({10, 8})));
}

}  // namespace
}  // namespace rprr
