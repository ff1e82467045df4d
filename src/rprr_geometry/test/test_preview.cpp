// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/preview.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

namespace rprr {
namespace {

// A slanted plane with a nearer box on it and a hole; smooth colours.
struct Scene {
  DepthFrame depth;
  cv::Mat bgr;
  explicit Scene(int width = 640, int height = 480)
      : depth{cv::Mat(height, width, CV_16UC1), 0.001}, bgr(height, width, CV_8UC3) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double q = 0.3 + 0.0002 * u + 0.0003 * v;
        depth.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(1000.0 / q));
        bgr.at<cv::Vec3b>(v, u) = cv::Vec3b(
            static_cast<std::uint8_t>(u * 255 / width), static_cast<std::uint8_t>(v * 255 / height),
            static_cast<std::uint8_t>(128 + 60 * std::sin(0.02 * (u + v))));
      }
    }
    const cv::Rect image(0, 0, width, height);
    depth.counts(cv::Rect(203, 100, 100, 120) & image).setTo(900);
    depth.counts(cv::Rect(400, 300, 64, 64) & image).setTo(0);
  }
};

TEST(Preview, ABlockOfAPlaneHasTheDepthOfItsCentre) {
  const Scene scene;
  const BlockPreview preview = make_preview(scene.depth, scene.bgr, 0.001);
  for (const auto& [column, row] : {std::pair{2, 2}, {70, 10}, {10, 50}}) {
    const double q = 0.3 + 0.0002 * (column * 8 + 3.5) + 0.0003 * (row * 8 + 3.5);
    EXPECT_NEAR(preview.q(column, row), q, 0.0011);
  }
}

TEST(Preview, ABlockAcrossAnEdgeTakesOneSideNotTheMean) {
  const Scene scene;
  const BlockPreview preview = make_preview(scene.depth, scene.bgr);
  // Column 25 holds pixels 200 to 207; the box starts at 203 and has most of it.
  EXPECT_NEAR(1.0 / preview.q(25, 15), 0.9, 0.01);
}

TEST(Preview, HolesStayHoles) {
  const Scene scene;
  const BlockPreview preview = make_preview(scene.depth, scene.bgr);
  EXPECT_FALSE(preview.valid(52, 40));
  EXPECT_TRUE(preview.valid(48, 40));
}

TEST(Preview, DepthComesBackExactlyAndColourNearly) {
  for (const auto& [width, height] : {std::pair{640, 480}, {540, 360}, {9, 7}, {8, 8}}) {
    const Scene scene(width, height);
    const BlockPreview preview = make_preview(scene.depth, scene.bgr);
    const Result<BlockPreview> back = decode_preview(encode_preview(preview, 60));
    ASSERT_TRUE(back) << back.reason() << " " << width << "x" << height;
    EXPECT_EQ(cv::norm(back->inverse_depth, preview.inverse_depth, cv::NORM_INF), 0.0);
    EXPECT_EQ(back->step, preview.step);
    if (width < 64) continue;  // chroma of a few pixels is shared by all of them
    EXPECT_LT(cv::norm(back->bgr, preview.bgr, cv::NORM_L1) / (3.0 * preview.grid.count()), 8.0);
  }
}

TEST(Preview, NoiseComesBackToo) {
  std::mt19937 random(2);
  BlockPreview preview = make_preview(Scene().depth, Scene().bgr);
  for (int i = 0; i < preview.grid.count(); ++i) {
    preview.inverse_depth.ptr<std::uint16_t>()[i] = static_cast<std::uint16_t>(random());
  }
  const Result<BlockPreview> back = decode_preview(encode_preview(preview, 30));
  ASSERT_TRUE(back) << back.reason();
  EXPECT_EQ(cv::norm(back->inverse_depth, preview.inverse_depth, cv::NORM_INF), 0.0);
}

TEST(Preview, EveryCutIsAnErrorAndHostileBytesNeverCrash) {
  const Scene scene;
  const Bytes good = encode_preview(make_preview(scene.depth, scene.bgr), 40);
  for (std::size_t size = 0; size < good.size(); ++size) {
    ASSERT_FALSE(decode_preview(ByteView(good).first(size))) << "cut to " << size;
  }
  std::mt19937 random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes bytes(good.begin(), good.end() - 4);
    for (int i = 0; i < 3; ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (trial % 5 == 0) bytes.resize(random() % bytes.size());
    seal(bytes);
    const Result<BlockPreview> preview = decode_preview(bytes);
    if (preview) {
      ASSERT_EQ(preview->bgr.size(), preview->inverse_depth.size());
    }
  }
}

TEST(Preview, PointsLieAtTheBlocksCentres) {
  const Scene scene;
  const Camera camera{640, 480, 525.0, 520.0, 319.5, 239.5};
  const BlockPreview preview = make_preview(scene.depth, scene.bgr, 0.001);
  const std::vector<PreviewPoint> points = preview_points(preview, camera);
  EXPECT_EQ(points.size(), static_cast<std::size_t>(cv::countNonZero(preview.inverse_depth)));
  ASSERT_TRUE(preview.valid(0, 0) && preview.valid(1, 0));
  const PreviewPoint& second = points[1];
  const double z = 1.0 / preview.q(1, 0);
  EXPECT_NEAR(second.position.x(), (11.5 - 319.5) / 525.0 * z, 1e-4);
  EXPECT_NEAR(second.position.y(), (3.5 - 239.5) / 520.0 * z, 1e-4);
  EXPECT_NEAR(second.position.z(), z, 1e-4);
  EXPECT_EQ(second.bgr, preview.bgr.at<cv::Vec3b>(0, 1));
}

TEST(Preview, ThereAreNoPointsForACameraOfAnotherSize) {
  const Scene scene;
  const BlockPreview preview = make_preview(scene.depth, scene.bgr);
  EXPECT_TRUE(preview_points(preview, {320, 240, 262, 262, 159.5, 119.5}).empty());
}

}  // namespace
}  // namespace rprr
