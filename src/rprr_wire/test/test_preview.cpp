// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/preview.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <utility>
#include <vector>

#include "preview_scene.hpp"

namespace rprr {
namespace {

// What make_preview is to compute, one block at a time and in no hurry.
double slow_inverse(const DepthFrame& depth, const cv::Rect& rect) {
  std::vector<int> sampled;
  for (int v = rect.y; v < rect.y + rect.height; v += 2) {
    for (int u = rect.x + v / 2 % 2; u < rect.x + rect.width; u += 2) {
      const int value = depth.counts.at<std::uint16_t>(v, u);
      if (value != 0) sampled.push_back(value);
    }
  }
  if (sampled.size() < 3) return 0.0;
  std::sort(sampled.begin(), sampled.end());
  const int median = sampled[sampled.size() / 2];
  double sum = 0.0;
  int count = 0;
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    for (int u = rect.x; u < rect.x + rect.width; ++u) {
      const int value = depth.counts.at<std::uint16_t>(v, u);
      if (100 * std::abs(value - median) > 3 * median) continue;
      sum += 1.0 / (value * depth.unit);
      ++count;
    }
  }
  return 4 * count >= rect.area() ? sum / count : 0.0;
}

// Surfaces a little apart, holes, and now and then a reading of any size.
DepthFrame noisy_depth(int width, int height, int unit_in_tenths_of_mm, unsigned seed) {
  std::mt19937 random(seed);
  DepthFrame frame{cv::Mat(height, width, CV_16UC1), unit_in_tenths_of_mm * 1e-4};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const int surface = (u / 20 + v / 30) % 4 * 9000 + 1500;
      int value = surface + static_cast<int>(random() % 97) * surface / 2000;
      if (random() % 8 == 0) value = 0;
      if (random() % 50 == 0) value = static_cast<int>(random() % 65536);
      if ((u / 40 + v / 24) % 7 == 3) value = random() % 3 == 0 ? value : 0;
      if (random() % 200 == 0) value = 65535;
      frame.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(value);
    }
  }
  return frame;
}

TEST(Preview, ABlockOfAPlaneHasTheDepthOfItsCentre) {
  const PreviewScene scene;
  const BlockPreview preview = make_preview(scene.depth, scene.bgr, 0.001);
  for (const auto& [column, row] : {std::pair{2, 2}, {70, 10}, {10, 50}}) {
    const double q = 0.3 + 0.0002 * (column * 8 + 3.5) + 0.0003 * (row * 8 + 3.5);
    EXPECT_NEAR(preview.q(column, row), q, 0.0011);
  }
}

TEST(Preview, ABlockAcrossAnEdgeTakesOneSideNotTheMean) {
  const PreviewScene scene;
  // Column 25 holds pixels 200 to 207; the box starts at 203 and has most of it.
  EXPECT_NEAR(1.0 / make_preview(scene.depth, scene.bgr).q(25, 15), 0.9, 0.01);
  EXPECT_EQ(make_exact_preview(scene.depth, scene.bgr).depth.at<std::uint16_t>(15, 25), 900);
}

TEST(Preview, HolesStayHoles) {
  const PreviewScene scene;
  for (const BlockPreview& preview :
       {make_preview(scene.depth, scene.bgr), make_exact_preview(scene.depth, scene.bgr)}) {
    EXPECT_FALSE(preview.valid(52, 40));
    EXPECT_TRUE(preview.valid(48, 40));
    const int hole = preview.grid.index(52, 40);
    EXPECT_EQ(preview.q(hole), 0.0);
    EXPECT_EQ(preview.metres(hole), 0.0);
  }
}

TEST(Preview, OfAnyDepthsItIsWhatTheDefinitionSays) {
  for (const auto& [width, height] : {std::pair{640, 480}, {540, 360}, {33, 9}, {7, 1}, {1, 8}}) {
    const DepthFrame depth = noisy_depth(width, height, 10, 5);
    const BlockPreview preview = make_preview(depth, {}, 0.001);
    for (int block = 0; block < preview.grid.count(); ++block) {
      const double q = slow_inverse(depth, preview.grid.rect(block));
      ASSERT_EQ(preview.valid(block), q != 0.0) << width << "x" << height << " block " << block;
      if (q != 0.0) {
        ASSERT_NEAR(preview.q(block), std::max(q, 0.001), 0.0006 + 1e-4 * q) << block;
      }
    }
  }
}

TEST(Preview, AnExactDepthIsAReadingOfItsBlockNearestTheMean) {
  const DepthFrame depth = noisy_depth(540, 360, 2, 6);
  const BlockPreview preview = make_exact_preview(depth, {});
  EXPECT_EQ(preview.coding, PreviewDepth::kCounts);
  EXPECT_FLOAT_EQ(static_cast<float>(preview.step), 2e-4f);
  int valid = 0;
  for (int block = 0; block < preview.grid.count(); ++block) {
    const cv::Rect rect = preview.grid.rect(block);
    const double q = slow_inverse(depth, rect);
    ASSERT_EQ(preview.valid(block), q != 0.0);
    if (q == 0.0) continue;
    ++valid;
    const int chosen = preview.depth.ptr<std::uint16_t>()[block];
    const double wanted = 1.0 / (q * depth.unit);
    bool occurs = false;
    for (int v = rect.y; v < rect.y + rect.height; ++v) {
      for (int u = rect.x; u < rect.x + rect.width; ++u) {
        const int value = depth.counts.at<std::uint16_t>(v, u);
        occurs = occurs || value == chosen;
        if (value == 0) continue;
        ASSERT_GE(std::abs(value - wanted) + 2.0 + 5e-5 * wanted, std::abs(chosen - wanted));
      }
    }
    ASSERT_TRUE(occurs) << block;
    EXPECT_NEAR(preview.metres(block), chosen * depth.unit, 1e-5);
    EXPECT_NEAR(preview.q(block) * preview.metres(block), 1.0, 1e-12);
  }
  EXPECT_GT(valid, preview.grid.count() / 2);
}

TEST(Preview, ResolutionIsThatOfWhatIsCounted) {
  const PreviewScene scene;
  const BlockPreview rounded = make_preview(scene.depth, scene.bgr, 0.003);
  EXPECT_NEAR(rounded.resolution(2.0), 0.012, 1e-6);
  const BlockPreview exact = make_exact_preview(scene.depth, scene.bgr);
  EXPECT_NEAR(exact.resolution(2.0), 0.001, 1e-6);
}

TEST(Preview, ColoursAreRoundedMeansAndGreyWithoutAnImageThatFits) {
  std::mt19937 random(7);
  cv::Mat bgr(61, 77, CV_8UC3);
  for (auto it = bgr.begin<cv::Vec3b>(); it != bgr.end<cv::Vec3b>(); ++it) {
    for (int c = 0; c < 3; ++c) (*it)[c] = static_cast<std::uint8_t>(random() % 7 == 0 ? 255 : 240);
  }
  const DepthFrame depth{cv::Mat(61, 77, CV_16UC1, cv::Scalar(1000)), 0.001};
  const BlockPreview preview = make_preview(depth, bgr);
  for (int block = 0; block < preview.grid.count(); ++block) {
    const cv::Scalar mean = cv::mean(bgr(preview.grid.rect(block)));
    const cv::Vec3b colour = preview.bgr.ptr<cv::Vec3b>()[block];
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(colour[c], mean[c], 0.501);
  }
  EXPECT_EQ(make_preview(depth, cv::Mat(61, 76, CV_8UC3)).bgr.at<cv::Vec3b>(3, 3),
            cv::Vec3b(128, 128, 128));
}

TEST(Preview, WhatDoesNotFitTogetherIsNotWellFormed) {
  const PreviewScene scene(64, 48);
  const BlockPreview good = make_preview(scene.depth, scene.bgr);
  EXPECT_TRUE(good.well_formed());
  BlockPreview bad = good;
  bad.depth = cv::Mat(6, 7, CV_16UC1);
  EXPECT_FALSE(bad.well_formed());
  bad = good;
  bad.bgr = cv::Mat(6, 8, CV_8UC1);
  EXPECT_FALSE(bad.well_formed());
  bad = good;
  bad.step = 0.0;
  EXPECT_FALSE(bad.well_formed());
}

TEST(Preview, PointsLieAtTheBlocksCentres) {
  const PreviewScene scene;
  const Camera camera{640, 480, 525.0, 520.0, 319.5, 239.5};
  const BlockPreview preview = make_preview(scene.depth, scene.bgr, 0.001);
  const std::vector<PreviewPoint> points = preview_points(preview, camera);
  EXPECT_EQ(points.size(), static_cast<std::size_t>(cv::countNonZero(preview.depth)));
  ASSERT_TRUE(preview.valid(0, 0) && preview.valid(1, 0));
  const PreviewPoint& second = points[1];
  const double z = 1.0 / preview.q(1, 0);
  EXPECT_NEAR(second.position.x(), (11.5 - 319.5) / 525.0 * z, 1e-4);
  EXPECT_NEAR(second.position.y(), (3.5 - 239.5) / 520.0 * z, 1e-4);
  EXPECT_NEAR(second.position.z(), z, 1e-4);
  EXPECT_EQ(second.bgr, preview.bgr.at<cv::Vec3b>(0, 1));
}

TEST(Preview, ThereAreNoPointsForACameraOfAnotherSize) {
  const PreviewScene scene;
  const BlockPreview preview = make_preview(scene.depth, scene.bgr);
  EXPECT_TRUE(preview_points(preview, {320, 240, 262, 262, 159.5, 119.5}).empty());
}

}  // namespace
}  // namespace rprr
