// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../src/preview_depth.hpp"
#include "preview_scene.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {
namespace {

constexpr std::size_t kFlagsAt = 5;
constexpr std::size_t kStepAt = 6;

void expect_same_depth(const BlockPreview& back, const BlockPreview& preview) {
  ASSERT_EQ(back.depth.size(), preview.depth.size());
  EXPECT_EQ(cv::norm(back.depth, preview.depth, cv::NORM_INF), 0.0);
  EXPECT_EQ(back.step, preview.step);
  EXPECT_EQ(back.coding, preview.coding);
}

// Both codings, and of counts both forms.
std::vector<BlockPreview> previews_of(int width, int height) {
  const PreviewScene smooth(width, height);
  PreviewScene kinect(width, height);
  kinect.quantise();
  return {make_preview(smooth.depth, smooth.bgr), make_exact_preview(smooth.depth, smooth.bgr),
          make_exact_preview(kinect.depth, kinect.bgr)};
}

TEST(PreviewWire, DepthComesBackExactlyAndColourNearly) {
  for (const auto& [width, height] : {std::pair{640, 480}, {540, 360}, {9, 7}, {8, 8}, {1, 1}}) {
    for (const BlockPreview& preview : previews_of(width, height)) {
      const Result<BlockPreview> back = decode_preview(encode_preview(preview, 60));
      ASSERT_TRUE(back) << back.reason() << " " << width << "x" << height;
      expect_same_depth(*back, preview);
      ASSERT_EQ(back->bgr.size(), preview.bgr.size());
      if (width < 64) continue;  // chroma of a few pixels is shared by all of them
      EXPECT_LT(cv::norm(back->bgr, preview.bgr, cv::NORM_L1) / (3.0 * preview.grid.count()), 8.0);
    }
  }
}

TEST(PreviewWire, FewDistinctReadingsGoAsRanksAndCostLess) {
  const std::vector<BlockPreview> previews = previews_of(640, 480);
  const Bytes kinect = encode_preview(previews[2], 40);
  EXPECT_EQ(encode_preview(previews[0], 40)[kFlagsAt], 0);
  EXPECT_EQ(kinect[kFlagsAt], 3);
  EXPECT_LT(encode_preview_depth(previews[2].depth, true).size(),
            encode_preview_depth(previews[2].depth, false).size());
}

TEST(PreviewWire, ItsPartsAddUp) {
  const Bytes bytes = encode_preview(previews_of(320, 240)[0], 40);
  EXPECT_EQ(preview_depth_bytes(bytes) + preview_colour_bytes(bytes) + 18, bytes.size());
  EXPECT_EQ(preview_depth_bytes(ByteView(bytes).first(30)), 0u);
  EXPECT_EQ(preview_colour_bytes({}), 0u);
}

TEST(PreviewWire, WithoutAnyReadingThereIsAlmostNothingToSend) {
  const DepthFrame blind{cv::Mat(480, 640, CV_16UC1, cv::Scalar(0)), 0.001};
  for (const BlockPreview& preview : {make_preview(blind, {}), make_exact_preview(blind, {})}) {
    const Bytes bytes = encode_preview(preview, 40);
    EXPECT_LT(bytes.size(), 150u);
    const Result<BlockPreview> back = decode_preview(bytes);
    ASSERT_TRUE(back) << back.reason();
    expect_same_depth(*back, preview);
  }
}

TEST(PreviewWire, NoiseComesBackToo) {
  std::mt19937 random(2);
  for (BlockPreview preview : previews_of(640, 480)) {
    for (int i = 0; i < preview.grid.count(); ++i) {
      // Any 16 bits, or few values far apart, so that both forms of counts are met.
      const auto any = static_cast<std::uint16_t>(random());
      preview.depth.ptr<std::uint16_t>()[i] =
          preview.coding == PreviewDepth::kCounts && i % 5 != 0 ? any & 0xFC0F : any;
    }
    for (const bool ranks : {false, true}) {
      cv::Mat back(preview.depth.size(), CV_16UC1, cv::Scalar(7));
      ASSERT_TRUE(decode_preview_depth(encode_preview_depth(preview.depth, ranks), ranks, back));
      EXPECT_EQ(cv::norm(back, preview.depth, cv::NORM_INF), 0.0);
    }
    const Result<BlockPreview> back = decode_preview(encode_preview(preview, 30));
    ASSERT_TRUE(back) << back.reason();
    expect_same_depth(*back, preview);
  }
}

// Two robots must agree on every bit, whatever they run on: a change here is a change of version.
TEST(PreviewWire, TheDepthCoderWritesTheBytesThatItAlwaysWrote) {
  cv::Mat depth(30, 40, CV_16UC1);
  std::uint32_t state = 1;
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column) {
      state = state * 1664525u + 1013904223u;
      int value = 300 + 2 * column + row + static_cast<int>(state >> 30);
      if (column > 12 && column < 22 && row > 7) value += 150;
      if (state >> 24 == 9) value = static_cast<int>(state >> 8 & 0xFFFF);
      if (row > 20 && column > 30 && (state >> 20 & 3) != 0) value = 0;
      depth.at<std::uint16_t>(row, column) = static_cast<std::uint16_t>(value);
    }
  }
  EXPECT_EQ(crc32(encode_preview_depth(depth, false)), 381578365u);
  EXPECT_EQ(crc32(encode_preview_depth(depth, true)), 3286940226u);
}

TEST(PreviewWire, EveryCutIsAnError) {
  for (const BlockPreview& preview : previews_of(320, 240)) {
    const Bytes good = encode_preview(preview, 40);
    for (std::size_t size = 0; size < good.size(); ++size) {
      ASSERT_FALSE(decode_preview(ByteView(good).first(size))) << "cut to " << size;
    }
  }
}

TEST(PreviewWire, ImpossibleHeadersAreErrorsThatSayWhy) {
  const Bytes good = encode_preview(previews_of(320, 240)[0], 40);
  const auto reason_with = [&](std::size_t at, const Bytes& instead) {
    Bytes bytes(good.begin(), good.end() - 4);
    std::copy(instead.begin(), instead.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
    seal(bytes);
    const Result<BlockPreview> preview = decode_preview(bytes);
    return preview ? std::string() : preview.reason();
  };
  EXPECT_NE(reason_with(0, {1}).find("version"), std::string::npos);
  EXPECT_NE(reason_with(1, {0, 0}).find("size"), std::string::npos);
  EXPECT_NE(reason_with(3, {0xFF, 0xFF}).find("size"), std::string::npos);
  EXPECT_NE(reason_with(kFlagsAt, {4}).find("kind"), std::string::npos);
  EXPECT_NE(reason_with(10, {0xFF, 0xFF, 0xFF, 0xFF}).find("length"), std::string::npos);
  for (const float step : {0.0f, -1.0f, 2.0f, std::nanf("")}) {
    Bytes raw(4);
    std::memcpy(raw.data(), &step, 4);
    EXPECT_NE(reason_with(kStepAt, raw).find("step"), std::string::npos) << step;
  }
}

TEST(PreviewWire, HostileBytesNeverCrash) {
  std::mt19937 random(3);
  for (const BlockPreview& source : previews_of(640, 480)) {
    const Bytes good = encode_preview(source, 40);
    for (int trial = 0; trial < 1500; ++trial) {
      Bytes bytes(good.begin(), good.end() - 4);
      for (int i = 0; i < 3; ++i)
        bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      if (trial % 5 == 0) bytes.resize(random() % bytes.size());
      if (trial % 7 == 0) bytes[kFlagsAt] = static_cast<std::uint8_t>(random() % 4);
      seal(bytes);
      const Result<BlockPreview> preview = decode_preview(bytes);
      if (preview) {
        ASSERT_TRUE(preview->well_formed());
      }
    }
  }
}

TEST(PreviewWire, RandomPayloadsNeverCrashTheDepthDecoder) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 300; ++trial) {
    Bytes bytes(random() % 3000);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(trial % 3 == 0 ? 0xFF : random());
    cv::Mat depth(60, 80, CV_16UC1, cv::Scalar(0));
    decode_preview_depth(bytes, trial % 2 == 0, depth);
  }
}

}  // namespace
}  // namespace rprr
