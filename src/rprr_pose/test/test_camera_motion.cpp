// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/camera_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "textured_views.hpp"

namespace rprr {
namespace {

using Outcome = CameraMotion::Outcome;

// Noise of each reading of a Kinect: 1.4 mm at 1 m, growing with the square; a few grey levels.
std::shared_ptr<RgbdFrame> noisy_frame(const Pose& motion, unsigned seed, double exposure = 1.0) {
  auto frame = std::make_shared<RgbdFrame>(*textured_frame(motion, seed, "x", exposure));
  frame->depth = DepthFrame{frame->depth.counts.clone(), frame->depth.unit};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int v = 0; v < frame->bgr.rows; ++v) {
    for (int u = 0; u < frame->bgr.cols; ++u) {
      auto& count = frame->depth.counts.at<std::uint16_t>(v, u);
      const double z = count * frame->depth.unit;
      if (count != 0) {
        count = static_cast<std::uint16_t>(std::lround(count + 1.4 * z * z * normal(random)));
      }
      for (int k = 0; k < 3; ++k) {
        auto& level = frame->bgr.at<cv::Vec3b>(v, u)[k];
        level = static_cast<std::uint8_t>(std::clamp(level + 4.0 * normal(random), 0.0, 255.0));
      }
    }
  }
  return frame;
}

// A wall across the view, without texture.
RgbdFrame bare_wall(double metres, std::uint8_t grey) {
  RgbdFrame frame;
  frame.camera = kTestCamera;
  frame.depth = DepthFrame{cv::Mat(kTestCamera.height, kTestCamera.width, CV_16UC1,
                                   cv::Scalar(std::lround(1000.0 * metres))),
                           0.001};
  frame.bgr = cv::Mat(kTestCamera.height, kTestCamera.width, CV_8UC3, cv::Scalar::all(grey));
  return frame;
}

struct Motion {
  double metres;
  double degrees;
};
class KnownMotions : public testing::TestWithParam<Motion> {};

TEST_P(KnownMotions, AreRecovered) {
  const Pose truth = test_motion(GetParam().metres, GetParam().degrees);
  const RgbdFramePtr earlier = noisy_frame(Pose::Identity(), 1);
  const RgbdFramePtr later = noisy_frame(truth, 2);
  const CameraMotion found = camera_motion(*earlier, *later);
  ASSERT_EQ(found.outcome, Outcome::kMoved);
  EXPECT_LT(translation_error(found.later_from_earlier, truth), 0.015);
  EXPECT_LT(rotation_error(found.later_from_earlier, truth), 0.4);
  EXPECT_NEAR(found.metres, truth.inverse().translation().norm(), 0.015);
  EXPECT_NEAR(found.radians, rotation_angle(truth.linear()), 0.4 * M_PI / 180.0);
  EXPECT_GT(found.overlap, 0.3);
  EXPECT_LE(found.overlap, 1.0);

  const CameraMotion back = camera_motion(*later, *earlier);
  ASSERT_EQ(back.outcome, Outcome::kMoved);
  EXPECT_LT(translation_error(back.later_from_earlier.inverse(), found.later_from_earlier), 0.02);
  EXPECT_NEAR(back.overlap, found.overlap, 0.05);
}

INSTANTIATE_TEST_SUITE_P(CameraMotion, KnownMotions,
                         testing::Values(Motion{0.03, 0.0}, Motion{0.0, 2.0}, Motion{0.06, 3.0},
                                         Motion{-0.12, 4.0}, Motion{0.2, -6.0}, Motion{0.1, 12.0},
                                         Motion{0.0, -18.0}));

TEST(CameraMotion, OfAStillCameraIsNotReportedForItsNoise) {
  const RgbdFramePtr earlier = noisy_frame(Pose::Identity(), 1);
  for (unsigned seed = 2; seed < 12; ++seed) {
    const CameraMotion found = camera_motion(*earlier, *noisy_frame(Pose::Identity(), seed));
    EXPECT_EQ(found.outcome, Outcome::kStill) << found.metres << " m " << found.radians;
    EXPECT_GT(found.overlap, 0.9);
  }
}

TEST(CameraMotion, ExposureIsNoMotion) {
  const RgbdFramePtr earlier = noisy_frame(Pose::Identity(), 1);
  EXPECT_EQ(camera_motion(*earlier, *noisy_frame(Pose::Identity(), 2, 0.7)).outcome,
            Outcome::kStill);
}

TEST(CameraMotion, SharesLessTheFurtherTheCameraTurned) {
  const RgbdFramePtr earlier = noisy_frame(Pose::Identity(), 1);
  double before = 1.0;
  for (const double degrees : {1.0, 5.0, 10.0, 15.0}) {
    const CameraMotion found = camera_motion(*earlier, *noisy_frame(test_motion(0, degrees), 2));
    ASSERT_EQ(found.outcome, Outcome::kMoved) << degrees;
    EXPECT_LT(found.overlap, before);
    before = found.overlap;
  }
}

TEST(CameraMotion, AnotherSceneIsSaidToBeAnother) {
  const RgbdFramePtr earlier = noisy_frame(Pose::Identity(), 1);
  EXPECT_EQ(camera_motion(*earlier, *noisy_frame(test_motion(0.3, 150.0), 2)).outcome,
            Outcome::kSceneChanged);
  // Something large came close.
  auto covered = noisy_frame(Pose::Identity(), 2);
  covered->depth.counts.colRange(60, 260) = 700;
  covered->bgr.colRange(60, 260) = cv::Scalar(40, 60, 200);
  EXPECT_EQ(camera_motion(*earlier, *covered).outcome, Outcome::kSceneChanged);
  // Depth that has nothing to do with the scene.
  auto noise = noisy_frame(Pose::Identity(), 3);
  std::mt19937 random(4);
  for (int v = 0; v < noise->depth.counts.rows; v += 8) {
    for (int u = 0; u < noise->depth.counts.cols; u += 8) {
      noise->depth.counts(cv::Rect(u, v, 8, 8)) = 800 + static_cast<int>(random() % 3000);
    }
  }
  EXPECT_EQ(camera_motion(*earlier, *noise).outcome, Outcome::kSceneChanged);
}

TEST(CameraMotion, AHandInTheViewOfAStillCameraIsNoMotion) {
  const RgbdFramePtr earlier = noisy_frame(Pose::Identity(), 1);
  auto later = noisy_frame(Pose::Identity(), 2);
  later->depth.counts(cv::Rect(40, 100, 64, 48)) = 900;
  later->bgr(cv::Rect(40, 100, 64, 48)) = cv::Scalar(90, 130, 200);
  EXPECT_EQ(camera_motion(*earlier, *later).outcome, Outcome::kStill);
}

TEST(CameraMotion, WithoutDepthNothingIsSaid) {
  const RgbdFramePtr good = noisy_frame(Pose::Identity(), 1);
  auto blind = noisy_frame(Pose::Identity(), 2);
  blind->depth.counts = 0;
  EXPECT_EQ(camera_motion(*good, *blind).outcome, Outcome::kUnknown);
  EXPECT_EQ(camera_motion(*blind, *good).outcome, Outcome::kUnknown);
  EXPECT_EQ(camera_motion(*blind, *blind).outcome, Outcome::kUnknown);
}

TEST(CameraMotion, EmptyOrMisshapenFramesAreSurvived) {
  const RgbdFramePtr good = noisy_frame(Pose::Identity(), 1);
  const RgbdFrame empty;
  EXPECT_EQ(camera_motion(*good, empty).outcome, Outcome::kUnknown);
  EXPECT_EQ(camera_motion(empty, *good).outcome, Outcome::kUnknown);
  RgbdFrame other_size = *good;
  other_size.depth.counts = other_size.depth.counts.rowRange(0, 100);
  EXPECT_EQ(camera_motion(*good, other_size).outcome, Outcome::kUnknown);
  RgbdFrame tiny = *good;
  tiny.depth.counts = tiny.depth.counts(cv::Rect(0, 0, 3, 2));
  tiny.camera.width = 3;
  tiny.camera.height = 2;
  EXPECT_EQ(camera_motion(*good, tiny).outcome, Outcome::kUnknown);
}

TEST(CameraMotion, WhereAllPlacesLookAlikeNothingIsSaid) {
  EXPECT_EQ(camera_motion(bare_wall(1.5, 120), bare_wall(1.5, 120)).outcome, Outcome::kUnknown);
}

TEST(CameraMotion, DepthAloneServesWithoutColour) {
  RgbdFrame earlier = *noisy_frame(Pose::Identity(), 1);
  RgbdFrame later = *noisy_frame(test_motion(0.06, 3.0), 2);
  earlier.bgr = later.bgr = cv::Mat();
  const CameraMotion found = camera_motion(earlier, later);
  ASSERT_EQ(found.outcome, Outcome::kMoved);
  EXPECT_LT(translation_error(found.later_from_earlier, test_motion(0.06, 3.0)), 0.02);
}

}  // namespace
}  // namespace rprr
