// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/depth_edges.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

namespace rprr {
namespace {

cv::Mat depths(int width, int height, int value) {
  return cv::Mat(height, width, CV_16UC1, cv::Scalar(value));
}

// By definition, pixel by pixel.
cv::Mat expected(const cv::Mat& counts, const cv::Mat& predicted, int margin, float jump) {
  cv::Mat out = counts.clone();
  for (int v = 0; v < counts.rows; ++v) {
    for (int u = 0; u < counts.cols; ++u) {
      int nearest = 1 << 20;
      int farthest = 0;
      for (int y = std::max(v - margin, 0); y <= std::min(v + margin, counts.rows - 1); ++y) {
        for (int x = std::max(u - margin, 0); x <= std::min(u + margin, counts.cols - 1); ++x) {
          const int depth = counts.at<std::uint16_t>(y, x);
          if (depth == 0) continue;
          nearest = std::min(nearest, depth);
          farthest = std::max(farthest, depth);
        }
      }
      const bool edge = static_cast<float>(farthest) > (1.0f + jump) * static_cast<float>(nearest);
      if (edge && predicted.at<std::uint8_t>(v, u) != 0) out.at<std::uint16_t>(v, u) = 0;
    }
  }
  return out;
}

TEST(DepthEdges, EqualTheDefinitionOnNoiseWithHoles) {
  std::mt19937 random(3);
  for (const int margin : {0, 1, 2, 5}) {
    cv::Mat counts(37, 61, CV_16UC1);
    cv::Mat predicted(counts.size(), CV_8UC1);
    for (int i = 0; i < static_cast<int>(counts.total()); ++i) {
      const auto draw = random() % 20;
      counts.ptr<std::uint16_t>()[i] =
          static_cast<std::uint16_t>(draw == 0   ? 0
                                     : draw == 1 ? 60000
                                                 : 1000 + random() % 30);
      predicted.ptr<std::uint8_t>()[i] = static_cast<std::uint8_t>(random() % 4 == 0 ? 0 : 255);
    }
    const cv::Mat wanted = expected(counts, predicted, margin, 0.05f);
    DepthEdges(margin, 0.05f).clear(counts, predicted);
    EXPECT_EQ(cv::norm(counts, wanted, cv::NORM_INF), 0) << "margin " << margin;
  }
}

TEST(DepthEdges, SmoothSurfacesAndHolesAreNoEdges) {
  cv::Mat counts = depths(40, 20, 2000);
  counts(cv::Rect(10, 5, 6, 6)).setTo(0);
  counts.col(30).setTo(2050);
  const cv::Mat before = counts.clone();
  DepthEdges().clear(counts, cv::Mat(counts.size(), CV_8UC1, cv::Scalar(1)));
  EXPECT_EQ(cv::norm(counts, before, cv::NORM_INF), 0);
}

TEST(DepthEdges, OnlyPredictedDepthGoes) {
  cv::Mat counts = depths(40, 8, 1000);
  counts(cv::Rect(20, 0, 20, 8)).setTo(2000);
  cv::Mat predicted(counts.size(), CV_8UC1, cv::Scalar(1));
  predicted(cv::Rect(20, 0, 20, 8)).setTo(0);
  DepthEdges(2).clear(counts, predicted);
  EXPECT_EQ(counts.at<std::uint16_t>(4, 17), 1000);
  EXPECT_EQ(counts.at<std::uint16_t>(4, 18), 0);
  EXPECT_EQ(counts.at<std::uint16_t>(4, 19), 0);
  EXPECT_EQ(counts.at<std::uint16_t>(4, 20), 2000) << "received";
}

TEST(DepthEdges, ImagesSmallerThanTheMargin) {
  cv::Mat counts = depths(2, 1, 1000);
  counts.at<std::uint16_t>(0, 1) = 3000;
  DepthEdges(8).clear(counts, cv::Mat(counts.size(), CV_8UC1, cv::Scalar(1)));
  EXPECT_EQ(cv::countNonZero(counts), 0);
}

}  // namespace
}  // namespace rprr
