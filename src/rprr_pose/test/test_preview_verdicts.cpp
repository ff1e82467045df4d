// SPDX-License-Identifier: BSD-3-Clause
// Each cause of a rejection in a scene of its own, and each limit of PreviewLimits by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "rprr_pose/preview_pose.hpp"
#include "textured_views.hpp"

namespace rprr {
namespace {

const Pose kVerdictTruth = test_motion(0.12, 7.0);

using Change = std::function<void(RgbdFrame&)>;

RgbdFramePtr changed(const Pose& b_from_a, const std::string& robot, const Change& change) {
  auto frame = std::make_shared<RgbdFrame>(*textured_frame(b_from_a, 1, robot));
  change(*frame);
  return frame;
}

PoseVerdict verdict_of(const Change& a_change, const Change& b_change,
                       const PreviewLimits& limits = {}, const std::vector<Pose>& warm = {}) {
  const RgbdFramePtr a = changed(Pose::Identity(), "a", a_change);
  const RgbdFramePtr b = changed(kVerdictTruth, "b", b_change);
  const Result<BlockPreview> preview =
      decode_preview(encode_preview(make_preview(b->depth, b->bgr, 0.003), 40));
  PreviewPoseOptions options;
  options.limits = limits;
  return PreviewPoseEstimator(options).estimate(*a, *preview, kTestCamera, warm).verdict;
}

const Change kNothing = [](RgbdFrame&) {};

// Depth of every pixel times what a function of column and row says.
Change scaled_depth(const std::function<double(int, int)>& factor) {
  return [factor](RgbdFrame& frame) {
    frame.depth.counts = frame.depth.counts.clone();
    for (int v = 0; v < frame.depth.counts.rows; ++v) {
      for (int u = 0; u < frame.depth.counts.cols; ++u) {
        auto& counts = frame.depth.counts.at<std::uint16_t>(v, u);
        counts = static_cast<std::uint16_t>(std::lround(counts * factor(u, v)));
      }
    }
  };
}

Change coloured(const std::function<cv::Vec3b(cv::Vec3b, int, int)>& colour) {
  return [colour](RgbdFrame& frame) {
    frame.bgr = frame.bgr.clone();
    for (int v = 0; v < frame.bgr.rows; ++v) {
      for (int u = 0; u < frame.bgr.cols; ++u) {
        auto& pixel = frame.bgr.at<cv::Vec3b>(v, u);
        pixel = colour(pixel, u, v);
      }
    }
  };
}

Change black() {
  return coloured([](cv::Vec3b, int, int) { return cv::Vec3b(0, 0, 0); });
}

Change without_depth() {
  return scaled_depth([](int, int) { return 0.0; });
}

// A flat wall 2 m away, with a print that repeats every so many metres across and down; 0: never.
Change printed_wall(double across, double down) {
  const auto wave = [](int pixels, double period) {
    const double metres = 2.0 * pixels / kTestCamera.fx;
    return period > 0.0 ? 50.0 * std::sin(2.0 * M_PI * metres / period) : 0.0;
  };
  return [=](RgbdFrame& frame) {
    frame.depth.counts = cv::Mat(240, 320, CV_16UC1, cv::Scalar(2000));
    coloured([=](cv::Vec3b, int u, int v) {
      return cv::Vec3b::all(
          static_cast<std::uint8_t>(118.0 + wave(u - 160, across) + wave(v - 120, down)));
    })(frame);
  };
}

void expect_rejected(const PoseVerdict& verdict, PoseStatus status, PoseQuantity quantity) {
  EXPECT_EQ(verdict.status, status) << describe(verdict);
  EXPECT_EQ(verdict.quantity, quantity) << describe(verdict);
  if (is_lower_limit(quantity)) {
    EXPECT_LT(verdict.measured, verdict.needed) << describe(verdict);
  } else {
    EXPECT_GT(verdict.measured, verdict.needed) << describe(verdict);
  }
}

TEST(PreviewVerdicts, AnAcceptedPoseSaysByHowMuch) {
  const PoseVerdict searched = verdict_of(kNothing, kNothing);
  EXPECT_TRUE(searched.accepted()) << describe(searched);
  EXPECT_EQ(searched.quantity, PoseQuantity::kLogOdds);
  EXPECT_GT(searched.measured, searched.needed);
  EXPECT_EQ(searched.needed, 1.0f);
  const PoseVerdict warm = verdict_of(kNothing, kNothing, {}, {kVerdictTruth});
  EXPECT_TRUE(warm.accepted()) << describe(warm);
  EXPECT_EQ(warm.needed, 2.0f) << "without a search it needs more";
}

TEST(PreviewVerdicts, DepthWithoutAReadingIsTooFewPoints) {
  for (const bool at_a : {true, false}) {
    const PoseVerdict verdict =
        verdict_of(at_a ? without_depth() : kNothing, at_a ? kNothing : without_depth());
    EXPECT_EQ(describe(verdict), "too few points: points with depth 0, needs 40");
  }
}

TEST(PreviewVerdicts, BlackImagesAreAMatterOfColour) {
  expect_rejected(verdict_of(black(), kNothing), PoseStatus::kColourDisagrees,
                  PoseQuantity::kLogOdds);
  expect_rejected(verdict_of(kNothing, black()), PoseStatus::kColourDisagrees,
                  PoseQuantity::kLogOdds);
}

TEST(PreviewVerdicts, AStripedWallLeavesADirectionFree) {
  const Change stripes = printed_wall(0.0, 0.3);
  expect_rejected(verdict_of(stripes, stripes), PoseStatus::kFreeDirection,
                  PoseQuantity::kTranslationSigma);
}

TEST(PreviewVerdicts, APrintThatRepeatsIsAmbiguous) {
  const Change print = printed_wall(0.25, 0.25);
  expect_rejected(verdict_of(print, print), PoseStatus::kAmbiguous, PoseQuantity::kMargin);
  PreviewLimits limits;
  limits.min_evidence = 100.0;
  expect_rejected(verdict_of(print, print, limits), PoseStatus::kAmbiguous, PoseQuantity::kLogOdds);
}

TEST(PreviewVerdicts, WhatStandsBeforeOneCameraOnlyIsFreeSpaceSeenThrough) {
  const Change nearer = scaled_depth([](int u, int) { return u < 120 ? 0.7 : 1.0; });
  expect_rejected(verdict_of(kNothing, nearer), PoseStatus::kFreeSpaceViolated,
                  PoseQuantity::kFreeSpace);
}

TEST(PreviewVerdicts, DepthsThatFitNothingAreTheCauseWhereColoursAreGood) {
  // Steps of 6%: too far to be one surface, too near to be another.
  const Change uneven =
      scaled_depth([](int u, int v) { return (u / 48 + v / 48) % 2 ? 1.06 : 1.0; });
  PreviewLimits limits;
  limits.min_evidence = 13.7;
  EXPECT_TRUE(verdict_of(kNothing, kNothing, limits).accepted());
  expect_rejected(verdict_of(kNothing, uneven, limits), PoseStatus::kDepthDisagrees,
                  PoseQuantity::kLogOdds);
}

TEST(PreviewVerdicts, EveryLimitHasItsOwnCauseAndNamesItself) {
  struct Case {
    double PreviewLimits::*limit;
    double value;
    PoseStatus status;
    PoseQuantity quantity;
  };
  const Case cases[] = {
      {&PreviewLimits::min_overlap, 0.999, PoseStatus::kLittleOverlap, PoseQuantity::kOverlap},
      {&PreviewLimits::max_violating, -0.001, PoseStatus::kFreeSpaceViolated,
       PoseQuantity::kFreeSpace},
      {&PreviewLimits::max_sigma_translation, 1e-5, PoseStatus::kFreeDirection,
       PoseQuantity::kTranslationSigma},
      {&PreviewLimits::max_sigma_rotation, 1e-5, PoseStatus::kFreeDirection,
       PoseQuantity::kRotationSigma},
      {&PreviewLimits::min_margin, 1.001, PoseStatus::kAmbiguous, PoseQuantity::kMargin},
  };
  for (const Case& one : cases) {
    PreviewLimits limits;
    limits.*one.limit = one.value;
    const PoseVerdict verdict = verdict_of(kNothing, kNothing, limits);
    expect_rejected(verdict, one.status, one.quantity);
    EXPECT_EQ(verdict.needed, static_cast<float>(one.value));
  }
}

}  // namespace
}  // namespace rprr
