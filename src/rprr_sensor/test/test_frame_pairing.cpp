// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/frame_pairing.hpp"

#include <gtest/gtest.h>

namespace rprr {
namespace {

using Kind = DeviceImage::Kind;
constexpr Duration kPairPeriod = from_seconds(1.0 / 30.0);
constexpr Duration kMillisecond = 1000000;

/// An image whose one pixel is its number.
DeviceImage image(Kind kind, int number) {
  return {kind, cv::Mat(1, 1, CV_16UC1, cv::Scalar(number)), 0};
}

TEST(FramePairing, SteadyStreamsLoseNothingWhateverTheirPhase) {
  for (Duration phase = 0; phase < kPairPeriod; phase += kMillisecond) {
    FramePairing pairing(kPairPeriod / 2 + kMillisecond);
    int pairs = 0;
    for (int k = 0; k < 100; ++k) {
      auto pair = pairing.add(image(Kind::colour, k), k * kPairPeriod);
      pairs += pair ? 1 : 0;
      pair = pairing.add(image(Kind::depth, k), k * kPairPeriod + phase);
      pairs += pair ? 1 : 0;
    }
    EXPECT_GE(pairs, 99) << "phase " << to_seconds(phase);
    EXPECT_LE(pairing.unpaired(), 1u);
  }
}

TEST(FramePairing, StampsOfAPairAreWithinTheWindowAndItsOwn) {
  FramePairing pairing(10 * kMillisecond);
  EXPECT_FALSE(pairing.add(image(Kind::colour, 1), 100 * kMillisecond));
  EXPECT_FALSE(pairing.add(image(Kind::depth, 2), 111 * kMillisecond)) << "too far apart";
  const auto pair = pairing.add(image(Kind::colour, 3), 121 * kMillisecond);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->colour_stamp, 121 * kMillisecond);
  EXPECT_EQ(pair->depth_stamp, 111 * kMillisecond);
  EXPECT_EQ(pair->colour.pixels.at<std::uint16_t>(0), 3);
  EXPECT_EQ(pair->depth.pixels.at<std::uint16_t>(0), 2);
  EXPECT_EQ(pairing.unpaired(), 1u) << "the first image";
}

TEST(FramePairing, OneStreamAloneGivesNothingAndDoesNotGrow) {
  FramePairing pairing(kPairPeriod);
  for (int k = 0; k < 1000; ++k) EXPECT_FALSE(pairing.add(image(Kind::depth, k), k * kPairPeriod));
  EXPECT_GE(pairing.unpaired(), 990u);
  EXPECT_TRUE(pairing.add(image(Kind::colour, 0), 999 * kPairPeriod));
}

TEST(FramePairing, ClockThatJumpsBackBeginsAnew) {
  FramePairing pairing(5 * kMillisecond);
  EXPECT_FALSE(pairing.add(image(Kind::colour, 1), from_seconds(50.0)));
  EXPECT_FALSE(pairing.add(image(Kind::colour, 2), from_seconds(1.0)));
  const auto pair = pairing.add(image(Kind::depth, 3), from_seconds(1.0));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->colour.pixels.at<std::uint16_t>(0), 2);
}

}  // namespace
}  // namespace rprr
