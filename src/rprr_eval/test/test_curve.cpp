// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/curves/curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rprr {
namespace {

std::vector<CurvePoint> random_points(std::uint32_t seed, int count = 12) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(0.05, 0.5);
  std::vector<CurvePoint> points;
  double bytes = 1000.0;
  double value = 20.0;
  for (int i = 0; i < count; ++i) {
    points.push_back({bytes, value});
    bytes *= 1.0 + step(random);
    value += step(random);
  }
  return points;
}

std::vector<CurvePoint> shifted(std::vector<CurvePoint> points, double factor, double offset) {
  for (CurvePoint& point : points) {
    point.bytes *= factor;
    point.value += offset;
  }
  return points;
}

double shortfall(const Curve& curve, const Curve& rival) {
  return worst_shortfall(curve, rival).value;
}

TEST(Curve, IsLinearInTheLogarithmOfBytes) {
  const Curve curve({{1000, 20}, {4000, 30}});
  EXPECT_DOUBLE_EQ(*curve.at(1000), 20.0);
  EXPECT_NEAR(*curve.at(2000), 25.0, 1e-12);
  EXPECT_DOUBLE_EQ(*curve.at(4000), 30.0);
  EXPECT_NEAR(*curve.bytes_for(25.0), 2000.0, 1e-9);
}

TEST(Curve, HasNothingBelowItsFirstPointAndGoesOnLevelBeyondTheLast) {
  const Curve curve({{1000, 20}, {4000, 30}});
  EXPECT_FALSE(curve.at(999));
  EXPECT_DOUBLE_EQ(*curve.at(1e9), 30.0);
  EXPECT_DOUBLE_EQ(*curve.bytes_for(-5.0), 1000.0) << "it cannot do with less";
  EXPECT_FALSE(curve.bytes_for(30.1));
}

TEST(Curve, OrderDoesNotMatterAndTheBestOfEqualBytesCounts) {
  const Curve curve({{4000, 30}, {1000, 20}, {4000, 28}, {1000, 18}});
  ASSERT_EQ(curve.points().size(), 2u);
  EXPECT_DOUBLE_EQ(*curve.at(1000), 20.0);
  EXPECT_DOUBLE_EQ(*curve.at(4000), 30.0);
}

TEST(Curve, AnEmptyOneKnowsNothing) {
  const Curve curve({});
  EXPECT_TRUE(curve.empty());
  EXPECT_FALSE(curve.at(1000));
  EXPECT_FALSE(curve.bytes_for(20));
  EXPECT_FALSE(median_byte_ratio(curve, Curve(random_points(1))));
}

TEST(Curve, BytesAndValuesAgree) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Curve curve(random_points(seed));
    for (double value = curve.least_value(); value < curve.greatest_value(); value += 0.07) {
      EXPECT_NEAR(*curve.at(*curve.bytes_for(value)), value, 1e-9);
    }
  }
}

TEST(Curve, IsOnItselfAndOnNothingAboveIt) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto points = random_points(seed);
    const Curve curve(points);
    EXPECT_EQ(shortfall(curve, curve), 0.0);
    EXPECT_NEAR(shortfall(Curve(shifted(points, 1.0, -0.3)), curve), 0.3, 1e-9);
    EXPECT_NEAR(shortfall(Curve(shifted(points, 1.0, 0.3)), curve), -0.3, 1e-9);
    EXPECT_TRUE(std::isinf(shortfall(Curve(shifted(points, 1.01, 9.0)), curve)))
        << "not there yet where the rival begins";
    EXPECT_LE(shortfall(Curve(shifted(points, 0.9, 0.0)), curve), 0.0) << "fewer bytes";
  }
}

TEST(Curve, ADipBetweenTheRivalsPointsIsFound) {
  const Curve rival({{1000, 20}, {16000, 30}});
  const Curve curve({{1000, 21}, {4000, 24}, {16000, 31}});
  EXPECT_NEAR(shortfall(curve, rival), 1.0, 1e-12);
  EXPECT_EQ(worst_shortfall(curve, rival).bytes, 4000.0);
  EXPECT_NEAR(
      shortfall(Curve({{1000, 21}, {16000, 31}}), Curve({{1000, 20}, {2000, 24}, {16000, 30}})),
      0.5, 1e-12);
}

TEST(Curve, WhatLiesOutsideOfTheRivalsBytesDoesNotCount) {
  const Curve rival({{1000, 20}, {2000, 22}});
  EXPECT_LE(shortfall(Curve({{500, 5}, {1000, 20}, {2000, 22}, {9000, 10}}), rival), 0.0);
}

TEST(Curve, BytesAtEqualValues) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto points = random_points(seed);
    const Curve curve(points);
    EXPECT_NEAR(*median_byte_ratio(curve, curve), 1.0, 1e-9);
    EXPECT_NEAR(*median_byte_ratio(Curve(shifted(points, 0.4, 0.0)), curve), 0.4, 1e-9);
    EXPECT_NEAR(*median_byte_ratio(curve, Curve(shifted(points, 0.4, 0.0))), 2.5, 1e-9);
  }
  EXPECT_FALSE(median_byte_ratio(Curve({{1, 1}, {2, 2}}), Curve({{1, 3}, {2, 4}})))
      << "no value that both reach";
}

}  // namespace
}  // namespace rprr
