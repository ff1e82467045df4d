// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_geometry/block_mask.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

const Camera kPlaneCamera{160, 120, 140, 140, 79.5, 59.5};

cv::Mat noise_image(int seed, double sigma = 60.0) {
  cv::Mat image(120, 160, CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(image, cv::RNG::NORMAL, 128, sigma);
  return image;
}

DepthFrame plane(int counts, double unit = 0.001) {
  return {cv::Mat(kPlaneCamera.height, kPlaneCamera.width, CV_16UC1, cv::Scalar(counts)), unit};
}

Pose shift(double x, double y = 0.0, double z = 0.0) {
  return Pose(Eigen::Translation3d(x, y, z));
}
Pose yaw(double degrees) {
  return Pose(Eigen::AngleAxisd(degrees * M_PI / 180.0, Eigen::Vector3d::UnitY()));
}

TEST(Psnr, KnownValues) {
  const cv::Mat truth(10, 20, CV_8UC3, cv::Scalar(50, 100, 150));
  EXPECT_DOUBLE_EQ(*psnr(truth, truth), 99.0);
  EXPECT_NEAR(*psnr(truth + cv::Scalar::all(10), truth), 10.0 * std::log10(255.0 * 255.0 / 100.0),
              1e-9);
  EXPECT_NEAR(*psnr(truth + cv::Scalar(0, 0, 10), truth),
              10.0 * std::log10(255.0 * 255.0 / (100.0 / 3.0)), 1e-9)
      << "all channels count";
  const cv::Mat black(10, 20, CV_8UC3, cv::Scalar::all(0));
  EXPECT_NEAR(*psnr(black, black + cv::Scalar::all(255)), 0.0, 1e-9);
}

TEST(Psnr, OnlyPixelsOfTheMaskCount) {
  const cv::Mat truth(10, 20, CV_8UC3, cv::Scalar(50, 100, 150));
  cv::Mat image = truth.clone();
  image.colRange(10, 20) += cv::Scalar::all(20);
  cv::Mat mask(10, 20, CV_8UC1, cv::Scalar(0));
  EXPECT_FALSE(psnr(image, truth, mask)) << "no pixel, no number";
  mask.colRange(0, 10) = 255;
  EXPECT_DOUBLE_EQ(*psnr(image, truth, mask), 99.0);
  mask.colRange(10, 20) = 1;
  EXPECT_DOUBLE_EQ(*psnr(image, truth, mask), *psnr(image, truth)) << "anything but 0 counts";
}

TEST(Ssim, OneForTheSameImageAndFallingWithNoise) {
  const cv::Mat truth = noise_image(1);
  EXPECT_NEAR(ssim(truth, truth), 1.0, 1e-6);
  double before = 1.0;
  for (const double sigma : {4.0, 12.0, 36.0}) {
    cv::Mat noise(truth.size(), CV_16SC3);
    cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0, sigma);
    cv::Mat noisy;
    cv::add(truth, noise, noisy, cv::noArray(), CV_8U);
    const double now = ssim(noisy, truth);
    EXPECT_LT(now, before) << "noise of " << sigma;
    before = now;
  }
  EXPECT_GT(before, 0.0);
  EXPECT_NEAR(ssim(truth, noise_image(2)), 0.0, 0.1) << "images that have nothing in common";
}

TEST(Ssim, ForgivesBrightnessMoreThanStructure) {
  const cv::Mat truth = noise_image(1, 30.0);
  cv::Mat noise(truth.size(), CV_16SC3);
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0, 20);
  cv::Mat noisy;
  cv::add(truth, noise, noisy, cv::noArray(), CV_8U);
  EXPECT_GT(ssim(truth + cv::Scalar::all(20), truth), ssim(noisy, truth) + 0.02);
}

TEST(PredictedDepthQuality, OnlyWhatWasNotReceivedCounts) {
  const DepthFrame truth = plane(2000);
  DepthFrame rebuilt = plane(2000);
  rebuilt.counts.rowRange(0, 40) = 2020;   // 1%
  rebuilt.counts.rowRange(40, 80) = 2200;  // 10%
  const BlockGrid grid(kPlaneCamera.width, kPlaneCamera.height);
  BlockMask received(grid);
  for (int block = 0; block < grid.count(); ++block) {
    if (grid.rect(block).y >= 80) received.set(block);
  }
  const PredictedDepthQuality quality = predicted_depth_quality(rebuilt, truth, received);
  EXPECT_EQ(quality.pixels, 80u * 160u);
  EXPECT_NEAR(quality.relative_rmse, std::sqrt((0.01 * 0.01 + 0.1 * 0.1) / 2.0), 1e-9);
  EXPECT_DOUBLE_EQ(quality.share_off, 0.5);
  rebuilt.counts.rowRange(40, 80) = 0;
  EXPECT_EQ(predicted_depth_quality(rebuilt, truth, received).pixels, 40u * 160u);
  EXPECT_EQ(predicted_depth_quality(rebuilt, truth, BlockMask(grid, true)).pixels, 0u);
  EXPECT_EQ(predicted_depth_quality(rebuilt, truth, {}).pixels, 0u) << "all received";
}

TEST(DepthQualityTest, ErrorInMillimetresAndCoverageOverTheTruthsPixels) {
  const DepthFrame truth = plane(2000);
  EXPECT_EQ(depth_quality(truth, truth).rmse_mm, 0.0);
  EXPECT_EQ(depth_quality(truth, truth).coverage, 1.0);

  DepthFrame rebuilt = plane(2010);
  rebuilt.counts.colRange(0, 40) = 0;  // a quarter is not rebuilt
  EXPECT_NEAR(depth_quality(rebuilt, truth).rmse_mm, 10.0, 1e-9);
  EXPECT_NEAR(depth_quality(rebuilt, truth).coverage, 0.75, 1e-9);

  DepthFrame holes = plane(2000);
  holes.counts.colRange(0, 40) = 0;  // nothing to be compared with there
  EXPECT_NEAR(depth_quality(rebuilt, holes).coverage, 1.0, 1e-9);
  EXPECT_NEAR(depth_quality(plane(10050, 0.0002), truth).rmse_mm, 10.0, 1e-9)
      << "each frame has its own unit";
}

TEST(DepthQualityTest, NothingIsZeroNotNan) {
  const DepthQuality quality = depth_quality(plane(0), plane(0));
  EXPECT_EQ(quality.rmse_mm, 0.0);
  EXPECT_EQ(quality.coverage, 0.0);
  EXPECT_EQ(depth_quality(plane(0), plane(2000)).coverage, 0.0);
}

TEST(Overlap, OfSyntheticPlanes) {
  const DepthFrame wall = plane(2000);
  const double width = 2.0 * kPlaneCamera.width / kPlaneCamera.fx;  // metres of the wall in view
  const auto of = [&](const DepthFrame& a, const DepthFrame& b, const Pose& b_from_a) {
    return overlap(a, kPlaneCamera, b, kPlaneCamera, b_from_a);
  };
  EXPECT_EQ(of(wall, wall, Pose::Identity()), 1.0);
  EXPECT_NEAR(of(wall, wall, shift(0.5 * width)), 0.5, 0.03);
  EXPECT_NEAR(of(wall, wall, shift(-0.25 * width)), 0.75, 0.03);
  EXPECT_EQ(of(wall, wall, shift(1.1 * width)), 0.0) << "out of view";
  EXPECT_EQ(of(wall, wall, yaw(180.0)), 0.0) << "behind b";
  EXPECT_EQ(of(wall, plane(1000), Pose::Identity()), 0.0) << "hidden from b";
  EXPECT_EQ(of(wall, plane(0), Pose::Identity()), 0.0) << "b has no depth";
  EXPECT_EQ(of(plane(0), wall, Pose::Identity()), 0.0) << "a has none: 0, not nan";
  EXPECT_EQ(of(wall, plane(2040), Pose::Identity()), 1.0) << "within 2 cm + 1.5%";
  EXPECT_EQ(of(wall, plane(2060), Pose::Identity()), 0.0) << "beyond 2 cm + 1.5%";
}

TEST(Overlap, MapsWithMabNotItsInverse) {
  // b stands half a metre nearer to the wall: M_ab takes half a metre off the depths.
  EXPECT_GT(overlap(plane(2000), kPlaneCamera, plane(1500), kPlaneCamera, shift(0, 0, -0.5)), 0.5);
  EXPECT_EQ(overlap(plane(2000), kPlaneCamera, plane(1500), kPlaneCamera, shift(0, 0, 0.5)), 0.0);
}

TEST(PoseErrorTest, IsZeroForTheTruthAndNotForItsInverse) {
  const Pose truth = shift(0.3, 0.1) * yaw(10.0);
  EXPECT_NEAR(pose_error(truth, truth).metres, 0.0, 1e-12);
  EXPECT_NEAR(pose_error(truth, truth).degrees, 0.0, 1e-6);
  EXPECT_GT(pose_error(truth.inverse(), truth).metres, 0.3);
  EXPECT_NEAR(pose_error(truth.inverse(), truth).degrees, 20.0, 1e-6);
}

TEST(PoseErrorTest, MetresAreBetweenCameraPositionsInAsFrame) {
  // b one metre beside a, turned by 90 degrees; the estimate has b a decimetre too far. M_ab's own
  // translation is b-centred, so a wrong rotation alone would change it: not so the position.
  const Pose b_in_a = shift(1.0) * yaw(90.0);
  const Pose farther = shift(1.1) * yaw(90.0);
  EXPECT_NEAR(pose_error(farther.inverse(), b_in_a.inverse()).metres, 0.1, 1e-9);
  EXPECT_NEAR(pose_error(farther.inverse(), b_in_a.inverse()).degrees, 0.0, 1e-6);
  const Pose turned = shift(1.0) * yaw(95.0);
  EXPECT_NEAR(pose_error(turned.inverse(), b_in_a.inverse()).metres, 0.0, 1e-9);
  EXPECT_NEAR(pose_error(turned.inverse(), b_in_a.inverse()).degrees, 5.0, 1e-6);
}

}  // namespace
}  // namespace rprr
