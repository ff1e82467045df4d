// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/raw_disparity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

TEST(RawDisparity, GrowsWithTheValueFromHalfAMetreToTen) {
  const DisparityTable table;
  int last = 0;
  for (std::uint16_t raw = 400; raw < 1050; ++raw) {
    const int millimetres = table.millimetres(raw);
    EXPECT_GE(millimetres, last) << raw;
    last = millimetres;
  }
  EXPECT_LT(table.millimetres(400), 520);
  EXPECT_GT(last, 8000);
  EXPECT_LE(last, 10000);
}

TEST(RawDisparity, StepsAreThoseOfAKinect) {
  const DisparityTable table;
  for (std::uint16_t raw = 500; raw < 1000; ++raw) {
    const double z = 0.001 * table.millimetres(raw);
    const double step = 0.001 * (table.millimetres(raw + 1) - table.millimetres(raw));
    EXPECT_NEAR(step, 2.85e-3 * z * z, 0.0012 + 0.1 * 2.85e-3 * z * z) << z;
  }
}

TEST(RawDisparity, ThereAndBackIsWithinHalfAStep) {
  const DisparityTable table;
  for (double z = 0.5; z < 8.0; z += 0.013) {
    EXPECT_NEAR(0.001 * table.millimetres(disparity_of(z)), z, 0.6 * 2.9e-3 * z * z + 0.0006) << z;
  }
}

TEST(RawDisparity, NoReadingAndNonsenseAreNone) {
  const DisparityTable table;
  for (const int raw : {2047, 2048, 4095, 65535, 1090, 1500}) {
    EXPECT_EQ(table.millimetres(static_cast<std::uint16_t>(raw)), 0) << raw;
  }
  for (const double z : {0.0, -1.0, std::nan("")}) EXPECT_EQ(disparity_of(z), kNoDisparity) << z;
}

TEST(RawDisparity, ImagesGoPixelByPixel) {
  cv::Mat raw(2, 3, CV_16UC1, cv::Scalar(kNoDisparity));
  raw.at<std::uint16_t>(1, 2) = 800;
  const DisparityTable table({3.3309495, 3.0711016e-3});
  const DepthFrame depth = table.depth(raw);
  EXPECT_EQ(depth.unit, 0.001);
  EXPECT_EQ(cv::countNonZero(depth.counts), 1);
  EXPECT_NEAR(depth.metres(2, 1), 1.0 / (3.3309495 - 3.0711016e-3 * 800), 0.0006);
}

}  // namespace
}  // namespace rprr
