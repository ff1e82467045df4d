// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_pose.hpp"

#include <gtest/gtest.h>

#include "textured_views.hpp"

namespace rprr {
namespace {

BlockPreview sent_preview(const RgbdFrame& frame) {
  const Result<BlockPreview> preview =
      decode_preview(encode_preview(make_preview(frame.depth, frame.bgr, 0.003), 40));
  return *preview;
}

PreviewPose estimate(const Pose& truth, double exposure = 1.0, const std::vector<Pose>& warm = {}) {
  const RgbdFramePtr a = textured_frame(Pose::Identity(), 1, "a");
  const RgbdFramePtr b = textured_frame(truth, 1, "b", exposure);
  PreviewPoseEstimator estimator({});
  return estimator.estimate(*a, sent_preview(*b), kTestCamera, warm);
}

TEST(PreviewPose, FindsMotionsFromFarApart) {
  for (const auto& [metres, degrees] :
       {std::pair{0.0, 0.0}, {0.1, 6.0}, {0.25, 14.0}, {0.1, -22.0}}) {
    const Pose truth = test_motion(metres, degrees);
    const PreviewPose found = estimate(truth);
    EXPECT_TRUE(found.verdict.accepted())
        << metres << " m, " << degrees << " deg: " << describe(found.verdict);
    EXPECT_LT(translation_error(found.b_from_a, truth), 0.03)
        << metres << " m, " << degrees << " deg";
    EXPECT_LT(rotation_error(found.b_from_a, truth), 0.8) << metres << " m, " << degrees << " deg";
  }
}

TEST(PreviewPose, AnotherExposureDoesNotMatter) {
  const Pose truth = test_motion(0.12, 7.0);
  const PreviewPose found = estimate(truth, 0.7);
  EXPECT_TRUE(found.verdict.accepted()) << describe(found.verdict);
  EXPECT_LT(translation_error(found.b_from_a, truth), 0.03);
}

TEST(PreviewPose, AWarmStartThatVerifiesSparesTheSearch) {
  const Pose truth = test_motion(0.12, 7.0);
  EXPECT_FALSE(estimate(truth, 1.0, {test_motion(0.10, 6.0)}).searched);
  const PreviewPose misled = estimate(truth, 1.0, {test_motion(-0.5, 40.0)});
  EXPECT_TRUE(misled.searched) << "a wrong warm start must not be believed";
  EXPECT_LT(translation_error(misled.b_from_a, truth), 0.03);
}

TEST(PreviewPose, NoOverlapIsAnAnswer) {
  EXPECT_FALSE(estimate(test_motion(0.2, 160.0)).verdict.accepted());
}

TEST(PreviewPose, ABareWallIsNotAccepted) {
  auto wall = std::make_shared<RgbdFrame>(*textured_frame(Pose::Identity(), 1, "a"));
  wall->depth.counts = cv::Mat(240, 320, CV_16UC1, cv::Scalar(2000));
  wall->bgr = cv::Mat(240, 320, CV_8UC3, cv::Scalar(180, 190, 200));
  PreviewPoseEstimator estimator({});
  EXPECT_FALSE(estimator.estimate(*wall, sent_preview(*wall), kTestCamera, {}).verdict.accepted());
}

TEST(PreviewPose, AFrameWithoutDepthIsNotAccepted) {
  auto blind = std::make_shared<RgbdFrame>(*textured_frame(Pose::Identity(), 1, "a"));
  blind->depth.counts = cv::Mat(240, 320, CV_16UC1, cv::Scalar(0));
  const RgbdFramePtr seeing = textured_frame(Pose::Identity(), 1, "b");
  PreviewPoseEstimator estimator({});
  EXPECT_FALSE(
      estimator.estimate(*blind, sent_preview(*seeing), kTestCamera, {}).verdict.accepted());
  PreviewPoseEstimator other({});
  EXPECT_FALSE(other.estimate(*seeing, sent_preview(*blind), kTestCamera, {}).verdict.accepted());
}

TEST(PreviewPose, NoCameraOfAPeerIsTooStrange) {
  const RgbdFramePtr a = textured_frame(Pose::Identity(), 1, "a");
  const BlockPreview preview = sent_preview(*a);
  for (const double focal : {0.0011, 0.01, 1.0, 1e4, 9.9e6}) {
    for (const double centre : {0.0, -9.9e5, 9.9e5}) {
      Camera camera = kTestCamera;
      camera.fx = camera.fy = focal;
      camera.cx = camera.cy = centre;
      ASSERT_TRUE(camera.valid()) << "one that the wire lets through";
      PreviewPoseEstimator estimator({});
      const PreviewPose pose = estimator.estimate(*a, preview, camera, {Pose::Identity()});
      EXPECT_FALSE(pose.verdict.accepted()) << focal << ", " << centre;
    }
  }
}

TEST(PreviewPose, NoWarmStartIsTooFarOff) {
  Pose away = Pose::Identity();
  away.translation().setConstant(1e30);
  const Pose truth = test_motion(0.12, 7.0);
  const PreviewPose found = estimate(truth, 1.0, {away});
  EXPECT_TRUE(found.searched);
  EXPECT_LT(translation_error(found.b_from_a, truth), 0.03);
}

TEST(PreviewPose, AFrameWithoutColourIsSurvivedAndNotBelieved) {
  auto colourless = std::make_shared<RgbdFrame>(*textured_frame(Pose::Identity(), 1, "a"));
  colourless->bgr.release();
  PreviewPoseEstimator estimator({});
  EXPECT_FALSE(estimator.estimate(*colourless, sent_preview(*colourless), kTestCamera, {})
                   .verdict.accepted());
}

TEST(PreviewPose, TheCovarianceIsOfTheRightSizeAndDirection) {
  const PreviewPose found = estimate(test_motion(0.1, 5.0));
  const Eigen::Matrix<double, 6, 1> sigma = found.covariance.diagonal().cwiseSqrt();
  EXPECT_GT(sigma.minCoeff(), 1e-5);
  EXPECT_LT(sigma.maxCoeff(), 0.02);
}

}  // namespace
}  // namespace rprr
