// SPDX-License-Identifier: BSD-3-Clause
#include "image_pairing.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace rprr {
namespace {

sensor_msgs::ImageConstPtr image_at(double seconds) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.stamp = ros::Time(seconds);
  return image;
}

// Two streams and the pairs that come of them, as stamps [s].
struct Streams {
  explicit Streams(double most_apart)
      : pairing(from_seconds(most_apart), [this](const auto& first, const auto& second) {
          pairs.emplace_back(first->header.stamp.toSec(), second->header.stamp.toSec());
        }) {}
  std::vector<std::pair<double, double>> pairs;
  ImagePairing pairing;
};

TEST(ImagePairing, EqualStampsPairAtOnce) {
  Streams streams(0.02);
  for (int i = 0; i < 20; ++i) {
    const double stamp = 100.0 + i / 30.0;
    streams.pairing.add_first(image_at(stamp));
    streams.pairing.add_second(image_at(stamp));
    ASSERT_EQ(streams.pairs.size(), static_cast<std::size_t>(i + 1));
    EXPECT_EQ(streams.pairs.back().first, streams.pairs.back().second);
  }
}

// Frames whose stamps are 4 ms apart belong together, at rates that the largest difference spans
// several frames of as well.
TEST(ImagePairing, NearestPairAtAnyRateAndAfterAnyLoss) {
  for (const double rate : {5.0, 30.0, 60.0, 90.0}) {
    Streams streams(0.02);
    std::mt19937 random(static_cast<unsigned>(rate));
    std::set<int> whole;
    for (int i = 0; i < 400; ++i) {
      const bool first = random() % 4 != 0;
      const bool second = random() % 4 != 0;
      if (first) streams.pairing.add_first(image_at(100.0 + i / rate));
      if (second) streams.pairing.add_second(image_at(100.0 + i / rate + 0.004));
      if (first && second) whole.insert(i);
    }
    std::size_t right = 0;
    for (const auto& [first, second] : streams.pairs) {
      const bool belongs = std::abs(second - first - 0.004) < 1e-6;
      right += belongs ? 1 : 0;
      EXPECT_LE(std::abs(second - first), 0.02 + 1e-6) << rate;
    }
    EXPECT_GE(static_cast<double>(right), 0.95 * static_cast<double>(whole.size()))
        << rate << " Hz";
  }
}

TEST(ImagePairing, WhatIsTooFarApartNeverPairs) {
  Streams streams(0.02);
  for (int i = 0; i < 50; ++i) {
    streams.pairing.add_first(image_at(100.0 + 0.1 * i));
    streams.pairing.add_second(image_at(100.05 + 0.1 * i));
  }
  EXPECT_TRUE(streams.pairs.empty());
}

TEST(ImagePairing, ARecordingThatStartsAgainGoesOn) {
  Streams streams(0.02);
  for (int run = 0; run < 3; ++run) {
    for (int i = 0; i < 10; ++i) {
      streams.pairing.add_first(image_at(100.0 + 0.1 * i));
      streams.pairing.add_second(image_at(100.0 + 0.1 * i));
    }
  }
  EXPECT_EQ(streams.pairs.size(), 30u);
}

}  // namespace
}  // namespace rprr
