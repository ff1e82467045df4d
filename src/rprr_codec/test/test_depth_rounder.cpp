// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/depth_rounder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <set>

namespace rprr {
namespace {

DepthFrame all_counts(double unit) {
  DepthFrame depth{cv::Mat(256, 256, CV_16UC1), unit};
  for (int i = 0; i < 65536; ++i) {
    depth.counts.at<std::uint16_t>(i / 256, i % 256) = static_cast<std::uint16_t>(i);
  }
  return depth;
}

TEST(DepthRounder, IsWithinHalfAStepOfInverseDepth) {
  for (const double unit : {0.001, 0.0002}) {
    for (const double step : {0.003, 0.012}) {
      DepthRounder rounder;
      const DepthFrame depth = all_counts(unit);
      const DepthFrame& rounded = rounder.round(depth, step);
      EXPECT_EQ(rounded.unit, unit);
      EXPECT_EQ(rounded.counts.at<std::uint16_t>(0, 0), 0) << "no reading stays none";
      for (int i = 1; i < 65536; ++i) {
        const double z = i * unit;
        const double other = rounded.counts.at<std::uint16_t>(i / 256, i % 256) * unit;
        ASSERT_GT(other, 0.0);
        // Counts round once more.
        ASSERT_LE(std::abs(1.0 / z - 1.0 / other), 0.5 * step + 0.51 * unit / (z * other) + 1e-9)
            << z << " m became " << other;
      }
    }
  }
}

TEST(DepthRounder, LeavesFewValues) {
  DepthRounder rounder;
  const DepthFrame& rounded = rounder.round(all_counts(0.001), 0.01);
  std::set<std::uint16_t> values;
  for (int i = 500; i < 10000; ++i) {  // 0.5 to 10 m: 190 steps
    values.insert(rounded.counts.at<std::uint16_t>(i / 256, i % 256));
  }
  EXPECT_LE(values.size(), 192u);
}

TEST(DepthRounder, FollowsUnitAndStep) {
  DepthRounder rounder;
  const DepthFrame fine = all_counts(0.0002);
  rounder.round(all_counts(0.001), 0.01);
  const cv::Mat used_before = rounder.round(fine, 0.003).counts.clone();
  DepthRounder fresh;
  EXPECT_EQ(cv::norm(used_before, fresh.round(fine, 0.003).counts, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace rprr
