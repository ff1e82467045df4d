// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "rprr_codec/dhcm.hpp"
#include "rprr_synthetic/coded_images.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

// As drivers make it: counts times the unit in single precision, NaN where there is no reading.
cv::Mat float_depth(const DepthFrame& frame, float unit) {
  cv::Mat metres(frame.counts.size(), CV_32FC1);
  for (int v = 0; v < metres.rows; ++v) {
    for (int u = 0; u < metres.cols; ++u) {
      const std::uint16_t count = frame.counts.at<std::uint16_t>(v, u);
      metres.at<float>(v, u) =
          count == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(count) * unit;
    }
  }
  return metres;
}

bool same_bits(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  for (int v = 0; v < a.rows; ++v) {
    if (std::memcmp(a.ptr(v), b.ptr(v), static_cast<std::size_t>(a.cols) * 4) != 0) return false;
  }
  return true;
}

std::size_t expect_lossless(const cv::Mat& metres, const std::string& what) {
  static DhcmDecoder decoder;
  std::size_t size = 0;
  for (const DhcmMode mode : {DhcmMode::kFast, DhcmMode::kSmall, DhcmMode::kDefault}) {
    DhcmEncoder encoder(mode);
    const Result<Bytes> payload = encoder.encode_float(metres, 0.0);
    EXPECT_TRUE(payload) << what << ": " << payload.reason();
    if (!payload) return 0;
    size = payload->size();
    EXPECT_LE(size, dhcm_bound(metres.size(), DhcmPixels::kFloat)) << what;
    const Result<DhcmInfo> info = dhcm_info(*payload);
    EXPECT_TRUE(info && info->pixels == DhcmPixels::kFloat && info->mode == mode) << what;
    const Result<cv::Mat> back = decoder.decode_float(*payload);
    EXPECT_TRUE(back) << what << ": " << back.reason();
    if (!back) return 0;
    EXPECT_TRUE(same_bits(*back, metres)) << what;
    EXPECT_FALSE(decoder.decode(*payload)) << "is no image of counts";
  }
  return size;
}

TEST(DhcmFloat, CountsOfUsualUnitsAreLosslessAndAsSmallAsCounts) {
  const DepthFrame frame = synthetic::kinect_like(160, 120);
  const std::size_t counts = DhcmEncoder().encode(frame).size();
  EXPECT_LE(expect_lossless(float_depth(frame, 0.001f), "mm"), counts + 32);
  EXPECT_LE(expect_lossless(float_depth(frame, 0.0002f), "freiburg"), counts + 32);
}

TEST(DhcmFloat, EveryBitPatternComesBack) {
  std::mt19937 random(5);
  cv::Mat metres(23, 41, CV_32FC1);
  for (int v = 0; v < metres.rows; ++v) {
    for (int u = 0; u < metres.cols; ++u) {
      const auto bits = static_cast<std::uint32_t>(random());
      std::memcpy(metres.ptr<float>(v) + u, &bits, sizeof(bits));
    }
  }
  const std::uint32_t special[] = {0,           0x80000000u, 0x7F800000u, 0xFF800000u, 0x7FC00000u,
                                   0xFFC00000u, 0x7F800001u, 0x7FC00001u, 1,           0x7FBFFFFFu};
  std::memcpy(metres.ptr<float>(3), special, sizeof(special));
  expect_lossless(metres, "noise");
  expect_lossless(cv::Mat(9, 9, CV_32FC1, cv::Scalar(0.0)), "zeros are not NaN");
  cv::Mat wave(60, 80, CV_32FC1);
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 80; ++u) wave.at<float>(v, u) = 1.0f + 0.001f * static_cast<float>(u * v);
  }
  expect_lossless(wave(cv::Rect(3, 5, 50, 41)), "a view into a larger image");
}

TEST(DhcmFloat, QuantisedReadingsAreWithinHalfAStep) {
  cv::Mat metres(48, 64, CV_32FC1);
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      metres.at<float>(v, u) =
          0.7f + 0.0173f * static_cast<float>(u) + 0.0031f * static_cast<float>(v);
    }
  }
  metres.at<float>(0, 0) = std::numeric_limits<float>::quiet_NaN();
  metres.at<float>(1, 1) = std::numeric_limits<float>::infinity();
  metres.at<float>(2, 2) = -1.0f;
  metres.at<float>(3, 3) = 0.0f;
  for (const double step : {0.001, 0.0005, 0.01}) {
    DhcmEncoder encoder;
    DhcmDecoder decoder;
    const Result<Bytes> payload = encoder.encode_float(metres, step);
    ASSERT_TRUE(payload) << payload.reason();
    const Result<DhcmInfo> info = dhcm_info(*payload);
    ASSERT_TRUE(info) << info.reason();
    EXPECT_EQ(info->pixels, DhcmPixels::kQuantisedFloat);
    EXPECT_EQ(info->unit, step);
    const Result<cv::Mat> back = decoder.decode_float(*payload);
    ASSERT_TRUE(back) << back.reason();
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        const float was = metres.at<float>(v, u);
        const float is = back->at<float>(v, u);
        if (std::isfinite(was) && was > 0.0f) {
          EXPECT_NEAR(is, was, 0.5 * step + 1e-6) << u << ", " << v;
        } else {
          EXPECT_TRUE(std::isnan(is)) << u << ", " << v;
        }
      }
    }
  }
}

TEST(DhcmFloat, WhatCannotBeKeptIsAnErrorAndNotARounding) {
  DhcmEncoder encoder;
  const cv::Mat metres(8, 8, CV_32FC1, cv::Scalar(2.0));
  EXPECT_FALSE(encoder.encode_float(metres, 2.0 / 65536)) << "beyond 65535 steps";
  EXPECT_TRUE(encoder.encode_float(metres, 2.0 / 65535));
  EXPECT_FALSE(encoder.encode_float(metres, 4.1)) << "would become no reading";
  EXPECT_FALSE(encoder.encode_float(metres, -0.001));
  EXPECT_FALSE(encoder.encode_float(metres, std::nan("")));
  EXPECT_FALSE(encoder.encode_float(cv::Mat(), 0.0));
  EXPECT_FALSE(encoder.encode_float(cv::Mat(8, 8, CV_16UC1, cv::Scalar(1)), 0.0));
  EXPECT_FALSE(encoder.encode_float(cv::Mat(1, 8193, CV_32FC1, cv::Scalar(1)), 0.0));
}

TEST(DhcmFloat, CountsAreNoFloatImage) {
  EXPECT_FALSE(DhcmDecoder().decode_float(DhcmEncoder().encode(synthetic::kinect_like(16, 16))));
}

TEST(DhcmFloat, CutAndDamagedPayloadsAreErrorsOrImagesOfTheStatedSize) {
  DhcmEncoder encoder;
  DhcmDecoder decoder(4096);
  std::mt19937 random(9);
  cv::Mat wave(20, 30, CV_32FC1);
  for (int i = 0; i < 600; ++i)
    wave.at<float>(i / 30, i % 30) = std::sqrt(static_cast<float>(i + 1));
  const std::vector<Bytes> payloads = {
      *encoder.encode_float(wave, 0.0), *encoder.encode_float(wave, 0.001),
      *encoder.encode_float(float_depth(synthetic::kinect_like(30, 20), 0.001f), 0.0)};
  for (const Bytes& payload : payloads) {
    for (std::size_t size = 0; size < payload.size(); ++size) {
      EXPECT_FALSE(decoder.decode_float(ByteView(payload).first(size))) << "cut to " << size;
    }
    for (int trial = 0; trial < 3000; ++trial) {
      Bytes hostile(payload.begin(), payload.end() - 4);
      for (std::uint32_t i = 0; i <= random() % 3; ++i) {
        hostile[random() % hostile.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
      }
      seal(hostile);
      const Result<cv::Mat> image = decoder.decode_float(hostile);
      if (image) {
        EXPECT_LE(image->total(), 4096u);
      }
    }
  }
}

}  // namespace
}  // namespace rprr
