// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/base_fill.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace rprr {
namespace {

PredictedView predicted(cv::Size size, int grey) {
  PredictedView view;
  view.bgr = cv::Mat(size, CV_8UC3, cv::Scalar::all(grey));
  view.metres = cv::Mat(size, CV_32FC1, cv::Scalar(2.0));
  view.provenance = cv::Mat(size, CV_8UC1, cv::Scalar(kPredicted));
  return view;
}

void forget(PredictedView& view, const cv::Rect& hole) {
  view.bgr(hole).setTo(0);
  view.provenance(hole).setTo(kNothing);
}

TEST(BaseFill, HolesContinueThePredictionInItsOwnLight) {
  for (const int reduction : {1, 2, 16}) {
    PredictedView view = predicted({160, 112}, 60);
    const cv::Rect hole(40, 30, 50, 40);
    forget(view, hole);
    const cv::Mat base(112 / reduction, 160 / reduction, CV_8UC3, cv::Scalar::all(90));
    BaseFill().fill({base, reduction, 2.0f}, view);
    EXPECT_LE(
        cv::norm(view.bgr, cv::Mat(view.bgr.size(), CV_8UC3, cv::Scalar::all(60)), cv::NORM_INF), 1)
        << reduction;
    EXPECT_EQ(cv::countNonZero(view.provenance(hole) != kBase), 0);
    EXPECT_EQ(cv::countNonZero(view.provenance == kBase), hole.area());
  }
}

TEST(BaseFill, TheBasesOwnStructureShowsInTheHole) {
  PredictedView view = predicted({96, 64}, 100);
  const cv::Rect hole(32, 16, 32, 32);
  forget(view, hole);
  cv::Mat base(64, 96, CV_8UC3, cv::Scalar::all(100));
  base(cv::Rect(44, 28, 8, 8)).setTo(180);
  BaseFill().fill({base, 1, 2.0f}, view);
  EXPECT_EQ(view.bgr.at<cv::Vec3b>(32, 48), cv::Vec3b(180, 180, 180));
  EXPECT_EQ(view.bgr.at<cv::Vec3b>(20, 36), cv::Vec3b(100, 100, 100));
}

TEST(BaseFill, WithoutAnyPredictionItIsTheBase) {
  PredictedView view = predicted({33, 17}, 0);
  forget(view, {0, 0, 33, 17});
  const cv::Mat base(17, 33, CV_8UC3, cv::Scalar(10, 20, 30));
  BaseFill().fill({base, 1, 2.0f}, view);
  EXPECT_EQ(cv::norm(view.bgr, base, cv::NORM_INF), 0);
}

TEST(BaseFill, PredictedPixelsStay) {
  PredictedView view = predicted({64, 64}, 70);
  const cv::Mat before = view.bgr.clone();
  BaseFill().fill({cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(200)), 1, 2.0f}, view);
  EXPECT_EQ(cv::norm(view.bgr, before, cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(view.provenance != kPredicted), 0);
}

}  // namespace
}  // namespace rprr
