// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/samples_wire.hpp"

#include <gtest/gtest.h>

#include <random>

#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"
#include "synthetic_views.hpp"

namespace rprr {
namespace {

SamplesContent example(bool with_normals, int columns = 640, int rows = 480) {
  std::mt19937 random(5);
  SamplesContent content;
  content.camera_hash = camera_hash(kTestCamera);
  content.known_peer_hash = 77;
  content.with_normals = with_normals;
  for (int i = 0; i < kSampleCount; ++i) {
    SamplePoint point{static_cast<std::uint16_t>(random() % static_cast<unsigned>(columns)),
                      static_cast<std::uint16_t>(random() % static_cast<unsigned>(rows)),
                      static_cast<std::uint16_t>(1 + random() % 65535), Eigen::Vector3f::Zero()};
    if (i % 7 != 0) {
      point.normal = Eigen::Vector3f(static_cast<float>(random() % 200) - 100.0f,
                                     static_cast<float>(random() % 200) - 100.0f,
                                     static_cast<float>(random() % 200) - 150.5f)
                         .normalized();
    }
    content.points.push_back(point);
  }
  return content;
}

void expect_equal(const SamplesContent& left, const SamplesContent& right) {
  ASSERT_EQ(left.points.size(), right.points.size());
  for (std::size_t i = 0; i < left.points.size(); ++i) {
    EXPECT_EQ(left.points[i].column, right.points[i].column);
    EXPECT_EQ(left.points[i].row, right.points[i].row);
    EXPECT_EQ(left.points[i].counts, right.points[i].counts);
    if (!left.with_normals) continue;
    EXPECT_EQ(left.points[i].normal.isZero(), right.points[i].normal.isZero());
    if (!left.points[i].normal.isZero()) {
      EXPECT_GT(left.points[i].normal.dot(right.points[i].normal), 0.9996f) << "within 1.6 deg";
    }
  }
}

TEST(SamplesWire, ThePapersPointsTakeThePapersBytes) {
  SamplesContent content = example(false);
  const std::size_t with_points = encode_samples(content, 640, 480).size();
  content.points.clear();
  EXPECT_EQ(with_points - encode_samples(content, 640, 480).size(), 1094u);
}

TEST(SamplesWire, RoundTripsNarrowAndWide) {
  for (const bool normals : {false, true}) {
    const SamplesContent narrow = example(normals);
    const Result<SamplesContent> back = decode_samples(encode_samples(narrow, 640, 480));
    ASSERT_TRUE(back) << back.reason();
    expect_equal(narrow, *back);
    EXPECT_EQ(back->unit, 0.001);
    EXPECT_EQ(back->known_peer_hash, 77u);
    const SamplesContent wide = example(normals, 4096, 3000);
    const Result<SamplesContent> wide_back = decode_samples(encode_samples(wide, 4096, 3000));
    ASSERT_TRUE(wide_back) << wide_back.reason();
    expect_equal(wide, *wide_back);
  }
}

TEST(SamplesWire, UnitsComeBackAsTheDecimalsThatWereMeant) {
  for (const double unit : {0.001, 0.0002, 0.0001, 0.00025}) {
    SamplesContent content = example(false);
    content.unit = unit;
    EXPECT_DOUBLE_EQ(decode_samples(encode_samples(content, 640, 480))->unit, unit);
  }
}

TEST(SamplesWire, TheCameraTravelsAlong) {
  SamplesContent content = example(true);
  content.camera = rounded_for_wire(kTestCamera);
  const Result<SamplesContent> back = decode_samples(encode_samples(content, 640, 480));
  ASSERT_TRUE(back) << back.reason();
  ASSERT_TRUE(back->camera);
  EXPECT_EQ(back->camera->width, kTestCamera.width);
}

TEST(SamplesWire, EveryCutAndEveryFlippedByteIsAnError) {
  const Bytes bytes = encode_samples(example(true), 640, 480);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode_samples(ByteView(bytes).first(size))) << "cut to " << size;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= 0x20;
    EXPECT_FALSE(decode_samples(damaged)) << "byte " << i;
  }
}

TEST(SamplesWire, HostileContentWithAValidChecksumNeverCrashes) {
  const Bytes good = encode_samples(example(true), 640, 480);
  std::mt19937 random(6);
  for (int trial = 0; trial < 5000; ++trial) {
    Bytes bytes(good.begin(), good.end() - 4);
    for (int i = 0; i < 3; ++i) bytes[random() % 40] = static_cast<std::uint8_t>(random());
    if (trial % 4 == 0) bytes.resize(random() % bytes.size());
    seal(bytes);
    const Result<SamplesContent> content = decode_samples(bytes);
    if (!content) continue;
    for (const SamplePoint& point : content->points) ASSERT_NE(point.counts, 0);
    ASSERT_GT(content->unit, 0.0);
  }
}

}  // namespace
}  // namespace rprr
