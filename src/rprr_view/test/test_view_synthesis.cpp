// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/view_synthesis.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace rprr {
namespace {

const Camera kA{160, 120, 140, 140, 79.5, 59.5};
const Camera kB{172, 100, 150, 148, 84.0, 51.0};

DepthFrame plane(int millimetres) {
  return {cv::Mat(kA.height, kA.width, CV_16UC1, cv::Scalar(millimetres)), 0.001};
}

// A colour ramp: blue grows with the column, green with the row.
cv::Mat ramp() {
  cv::Mat bgr(kA.height, kA.width, CV_8UC3);
  for (int v = 0; v < bgr.rows; ++v) {
    for (int u = 0; u < bgr.cols; ++u) {
      bgr.at<cv::Vec3b>(v, u) = {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v), 77};
    }
  }
  return bgr;
}

SynthesisOptions mode(Synthesis synthesis) {
  SynthesisOptions options;
  options.mode = synthesis;
  return options;
}

class BothModes : public testing::TestWithParam<Synthesis> {};
INSTANTIATE_TEST_SUITE_P(Modes, BothModes,
                         testing::Values(Synthesis::kForward, Synthesis::kBackward));

TEST_P(BothModes, IdentityReproducesTheReference) {
  PredictedView view;
  ViewSynthesizer(mode(GetParam())).synthesize(plane(2000), ramp(), kA, kA, Pose::Identity(), view);
  EXPECT_EQ(cv::norm(view.bgr, ramp(), cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(view.provenance != kPredicted), 0);
  EXPECT_NEAR(view.metres.at<float>(3, 4), 2.0f, 1e-5f);
}

// Truth for a plane is known for every pixel: intersect b's ray with it, look up a's ramp.
TEST_P(BothModes, PlaneUnderAKnownMotionAndOtherIntrinsics) {
  Twist twist;
  twist << 0.15, -0.05, 0.1, 0.05, -0.08, 0.1;
  const Pose b_from_a = exp_se3(twist);
  PredictedView view;
  ViewSynthesizer(mode(GetParam())).synthesize(plane(2000), ramp(), kA, kB, b_from_a, view);
  ASSERT_EQ(view.bgr.cols, kB.width);
  const Eigen::Vector3d normal = b_from_a.linear() * Eigen::Vector3d::UnitZ();
  const double offset = normal.dot(b_from_a * Eigen::Vector3d(0, 0, 2));
  int inside = 0;
  int missing = 0;
  for (int v = 0; v < kB.height; ++v) {
    for (int u = 0; u < kB.width; ++u) {
      const Eigen::Vector3d ray = kB.unproject(u, v, 1.0);
      const double z = offset / normal.dot(ray);
      const Eigen::Vector2d at = kA.project(b_from_a.inverse() * (z * ray));
      const bool well_inside =
          at.x() > 1 && at.y() > 1 && at.x() < kA.width - 2 && at.y() < kA.height - 2;
      if (!well_inside) continue;
      ++inside;
      if (view.provenance.at<std::uint8_t>(v, u) == kNothing) {
        ++missing;
        continue;
      }
      ASSERT_NEAR(view.metres.at<float>(v, u), z, 0.02) << u << ", " << v;
      const auto colour = view.bgr.at<cv::Vec3b>(v, u);
      ASSERT_NEAR(colour[0], at.x(), 1.6) << u << ", " << v;
      ASSERT_NEAR(colour[1], at.y(), 1.6) << u << ", " << v;
    }
  }
  EXPECT_GT(inside, 8000);
  EXPECT_LT(missing, inside / 100) << "cracks are closed";
}

TEST(ViewSynthesis, BackwardIsFinerThanForward) {
  Pose b_from_a = Pose::Identity();
  b_from_a.translation().x() = -0.5 * 2.0 / 140;  // half a pixel
  double error[2] = {0, 0};
  for (const int i : {0, 1}) {
    PredictedView view;
    ViewSynthesizer(mode(i == 0 ? Synthesis::kForward : Synthesis::kBackward))
        .synthesize(plane(2000), ramp(), kA, kA, b_from_a, view);
    for (int u = 10; u < 150; ++u) error[i] += std::abs(view.bgr.at<cv::Vec3b>(60, u)[0] - u - 0.5);
  }
  EXPECT_LE(error[1], error[0]);
}

// A near bar hides background from a. b sees that background; nothing may be invented there.
TEST(ViewSynthesis, DisocclusionStaysOpenAndBarColourDoesNotBleed) {
  DepthFrame a = plane(3000);
  cv::Mat bgr(kA.height, kA.width, CV_8UC3, cv::Scalar(0, 200, 0));
  a.counts(cv::Rect(70, 0, 20, 120)).setTo(1000);
  bgr(cv::Rect(70, 0, 20, 120)).setTo(cv::Scalar(0, 0, 250));
  Pose b_from_a = Pose::Identity();
  b_from_a.translation().x() = -0.2;  // bar moves by 28 pixels, background by 9.3
  PredictedView view;
  ViewSynthesizer().synthesize(a, bgr, kA, kA, b_from_a, view);
  EXPECT_EQ(view.provenance.at<std::uint8_t>(60, 70), kNothing);
  EXPECT_EQ(view.bgr.at<cv::Vec3b>(60, 70), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(view.bgr.at<cv::Vec3b>(60, 52), cv::Vec3b(0, 0, 250)) << "the bar";
  EXPECT_EQ(view.bgr.at<cv::Vec3b>(60, 100), cv::Vec3b(0, 200, 0)) << "the background";
  EXPECT_NEAR(view.metres.at<float>(60, 52), 1.0f, 1e-3f);
}

TEST(ViewSynthesis, ImagesOfAnotherSizePredictNothing) {
  PredictedView view;
  ViewSynthesizer synthesizer;
  synthesizer.synthesize(plane(2000), cv::Mat(10, 10, CV_8UC3), kA, kB, Pose::Identity(), view);
  EXPECT_EQ(cv::countNonZero(view.provenance), 0);
  EXPECT_EQ(cv::countNonZero(view.metres), 0);
  synthesizer.synthesize({}, ramp(), kA, kB, Pose::Identity(), view);
  EXPECT_EQ(view.bgr.size(), cv::Size(kB.width, kB.height));
}

}  // namespace
}  // namespace rprr
