// SPDX-License-Identifier: BSD-3-Clause
//
// Also DepthRegistration and Rectification, which it is made of.
#include "rprr_sensor/cameras/pair_processor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "rprr_synthetic/synthetic_scene.hpp"
#include "rprr_synthetic/trajectory.hpp"
#include "synthetic_kinect.hpp"

namespace rprr {
namespace {

DevicePair pair_of(const cv::Mat& colour, const cv::Mat& depth) {
  DevicePair pair;
  pair.colour.pixels = colour;
  pair.depth.pixels = depth;
  return pair;
}

cv::Mat millimetres(const cv::Mat& metres) {
  cv::Mat counts;
  metres.convertTo(counts, CV_16U, 1000.0);
  return counts;
}

class SyntheticRig : public testing::Test {
 protected:
  void SetUp() override {
    calibration_ = nominal_calibration(320, 240);
    calibration_.colour_from_depth = make_pose({-0.03, 0.004, 0.002}, {0.004, -0.006, 0.002, 1.0});
    const Pose world_from_colour = single_walk(1, 4)[0];
    const Scene room = make_room(4);
    colour_ = room.render(calibration_.colour.camera, world_from_colour);
    depth_ =
        room.render(calibration_.depth.camera, world_from_colour * calibration_.colour_from_depth);
    blank_ = cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(100));
  }
  RgbdCalibration calibration_;
  ExactView colour_;
  ExactView depth_;
  cv::Mat blank_;
};

TEST_F(SyntheticRig, OwnRegistrationShowsWhatTheColourCameraSees) {
  auto processor = PairProcessor::create(calibration_, DepthFormat::unregistered_mm);
  ASSERT_TRUE(processor) << processor.reason();
  const auto image = processor->process(pair_of(blank_, millimetres(depth_.metres)));
  ASSERT_TRUE(image) << image.reason();
  const DepthAgreement good = compare_depth(image->depth.counts, colour_.metres);
  EXPECT_GT(good.coverage, 0.78) << "all but the rim: depth has the smaller field of view";
  EXPECT_GT(good.near, 0.95);
  calibration_.colour_from_depth = Pose::Identity();
  auto naive = PairProcessor::create(calibration_, DepthFormat::unregistered_mm);
  const auto wrong = naive->process(pair_of(blank_, millimetres(depth_.metres)));
  EXPECT_LT(compare_depth(wrong->depth.counts, colour_.metres).near, good.near)
      << "the pose between the cameras matters";
}

TEST_F(SyntheticRig, RawDisparityIsRegisteredWithinTheSensorsSteps) {
  cv::Mat raw(240, 320, CV_16UC1);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      raw.at<std::uint16_t>(v, u) = disparity_of(depth_.metres.at<float>(v, u));
    }
  }
  auto processor = PairProcessor::create(calibration_, DepthFormat::disparity);
  ASSERT_TRUE(processor) << processor.reason();
  const auto image = processor->process(pair_of(blank_, raw));
  ASSERT_TRUE(image) << image.reason();
  EXPECT_EQ(image->depth.unit, 0.001);
  EXPECT_GT(compare_depth(image->depth.counts, colour_.metres).near, 0.95);
}

TEST(DepthRegistration, NearestSurfaceStays) {
  const Camera camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  DepthFrame depth{cv::Mat(48, 64, CV_16UC1, cv::Scalar(3000)), 0.001};
  depth.counts.colRange(40, 50).setTo(1000);
  Pose left = Pose::Identity();
  left.translation().x() = -0.1;  // moves the board 6 pixels, the wall 2
  DepthRegistration registration(camera, camera, left);
  const DepthFrame registered = registration.apply(depth);
  for (int u = 34; u < 44; ++u) EXPECT_EQ(registered.counts.at<std::uint16_t>(20, u), 1000) << u;
  EXPECT_EQ(registered.counts.at<std::uint16_t>(20, 32), 3000);
  EXPECT_EQ(registered.counts.at<std::uint16_t>(20, 46), 0) << "hidden from the depth camera";
}

TEST(PairProcessor, RegisteredDepthPassesUntouched) {
  auto processor = PairProcessor::create(nominal_calibration(64, 48), DepthFormat::registered_mm);
  ASSERT_TRUE(processor) << processor.reason();
  const cv::Mat colour(48, 64, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat depth(48, 64, CV_16UC1, cv::Scalar(1234));
  const auto image = processor->process(pair_of(colour, depth));
  ASSERT_TRUE(image) << image.reason();
  EXPECT_EQ(image->bgr.data, colour.data) << "no copy where nothing is to be done";
  EXPECT_EQ(image->depth.counts.data, depth.data);
}

TEST(PairProcessor, DistortionIsTakenOutOfBothAlike) {
  RgbdCalibration calibration = nominal_calibration(320, 240);
  calibration.colour.distortion = {0.2, -0.4, 0.001, -0.001, 0.0};
  auto processor = PairProcessor::create(calibration, DepthFormat::registered_mm);
  ASSERT_TRUE(processor) << processor.reason();
  // A straight vertical edge of the world, bent by the lens.
  const Camera& camera = calibration.colour.camera;
  cv::Mat colour(240, 320, CV_8UC3, cv::Scalar::all(0));
  cv::Mat depth(240, 320, CV_16UC1, cv::Scalar(1000));
  const auto& d = calibration.colour.distortion;
  for (int v = 0; v < 240; ++v) {
    const double y = (v - camera.cy) / camera.fy, x = 0.25;
    const double r2 = x * x + y * y;
    const double bent =
        x * (1 + d[0] * r2 + d[1] * r2 * r2) + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x);
    const int edge = static_cast<int>(std::lround(camera.fx * bent + camera.cx));
    colour.row(v).colRange(edge, 320).setTo(cv::Scalar::all(255));
    depth.row(v).colRange(edge, 320).setTo(3000);
  }
  const auto image = processor->process(pair_of(colour, depth));
  ASSERT_TRUE(image) << image.reason();
  const double edge = camera.fx * 0.25 + camera.cx;
  double worst = 0.0;
  for (int v = 20; v < 220; ++v) {
    int colour_edge = 0, depth_edge = 0;
    while (colour_edge < 319 && image->bgr.at<cv::Vec3b>(v, colour_edge)[0] < 128) ++colour_edge;
    while (depth_edge < 319 && image->depth.metres(depth_edge, v) < 2.0) ++depth_edge;
    worst = std::max({worst, std::abs(colour_edge - edge), std::abs(depth_edge - edge)});
  }
  EXPECT_LT(worst, 2.0) << "pixels that the edge is off";
  for (const auto count : cv::Mat_<std::uint16_t>(image->depth.counts)) {
    ASSERT_TRUE(count == 0 || count == 1000 || count == 3000) << "depth was mixed: " << count;
  }
}

TEST(PairProcessor, MismatchesAreRefusedInWords) {
  RgbdCalibration calibration = nominal_calibration(64, 48);
  auto processor = PairProcessor::create(calibration, DepthFormat::registered_mm);
  const auto image = processor->process(
      pair_of(cv::Mat(48, 64, CV_8UC3), cv::Mat(24, 32, CV_16UC1, cv::Scalar(0))));
  EXPECT_FALSE(image);
  EXPECT_NE(image.reason().find("32x24"), std::string::npos) << image.reason();
  calibration.colour.distortion = {0.1, 0.1, 0.1};
  EXPECT_FALSE(PairProcessor::create(calibration, DepthFormat::registered_mm));
  calibration.colour.distortion = {0.1, 0.1, 0.1, std::nan("")};
  EXPECT_FALSE(PairProcessor::create(calibration, DepthFormat::registered_mm));
  calibration = nominal_calibration(64, 48);
  calibration.colour.rectified.fx = 0.0;
  EXPECT_FALSE(PairProcessor::create(calibration, DepthFormat::registered_mm));
}

}  // namespace
}  // namespace rprr
