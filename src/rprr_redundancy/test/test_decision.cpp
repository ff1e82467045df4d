// SPDX-License-Identifier: BSD-3-Clause
// Synthetic truth: a wall with a smooth texture, seen by both, and what one of them sees otherwise.
#include "rprr_geometry/block_mask.hpp"
#include "rprr_redundancy/decision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "plane_views.hpp"

namespace rprr {
namespace {

constexpr int kQuality = 25;  // of the preview's colours

struct View {
  DepthFrame depth;
  cv::Mat bgr;
};

cv::Vec3b texture(double x, double y) {
  const auto level = [](double value) { return static_cast<std::uint8_t>(120 + 70 * value); };
  return {level(std::sin(3 * x) * std::cos(2 * y)), level(std::sin(4 * x + y)),
          level(std::cos(3 * y - x))};
}

// The wall z = 2 m in a's frame, from a camera moved to the right by `shift` metres.
View wall(const Camera& camera, double shift, unsigned seed) {
  View view{{cv::Mat(camera.height, camera.width, CV_16UC1), 0.001},
            cv::Mat(camera.height, camera.width, CV_8UC3)};
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, depth_sigma(2.0));
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d point = camera.unproject(u, v, 2.0);
      view.depth.counts.at<std::uint16_t>(v, u) =
          static_cast<std::uint16_t>(2000 + std::lround(1000 * noise(random)));
      view.bgr.at<cv::Vec3b>(v, u) = texture(point.x() + shift, point.y());
    }
  }
  return view;
}

Pose right_by(double metres) {
  Pose pose = Pose::Identity();
  pose.translation().x() = -metres;  // points move to the left when the camera moves to the right
  return pose;
}

class DecisionOfBothSizes : public testing::TestWithParam<Camera> {
 protected:
  static constexpr double kShift = 0.1;
  DecisionOfBothSizes() : camera(GetParam()), a(wall(camera, 0.0, 1)), b(wall(camera, kShift, 2)) {}

  BlockDecision decide() { return decide(make_preview(b.depth, b.bgr)); }
  BlockDecision decide(const BlockPreview& sent) {
    const auto preview = decode_preview(encode_preview(sent, kQuality));
    EXPECT_TRUE(preview) << preview.reason();
    return Decider().decide(a.depth, a.bgr, camera, camera, right_by(kShift), &*preview);
  }
  // Blocks of the mask outside of the rectangle and of the strip that a does not see.
  int elsewhere(const BlockMask& mask, const cv::Rect& rect) const {
    int count = 0;
    const auto strip = static_cast<int>(camera.fx * kShift / 2.0) + 16;
    for (int block = 0; block < mask.grid().count(); ++block) {
      const cv::Rect at = mask.grid().rect(block);
      const bool known = (at & rect).area() > 0 || at.x + at.width > camera.width - strip;
      count += mask[block] && !known ? 1 : 0;
    }
    return count;
  }
  int inside(const BlockMask& mask, const cv::Rect& rect) const {
    int count = 0;
    for (int block = 0; block < mask.grid().count(); ++block) {
      count += mask[block] && (mask.grid().rect(block) & rect) == mask.grid().rect(block) ? 1 : 0;
    }
    return count;
  }
  Camera camera;
  View a;
  View b;
  const cv::Rect patch{80, 80, 96, 64};  // whole blocks
  // Strong colours ring into their neighbours when the preview is coded.
  const cv::Rect around_patch{48, 48, 160, 128};
  const int patch_blocks = 12 * 8;
};
INSTANTIATE_TEST_SUITE_P(Sizes, DecisionOfBothSizes, testing::Values(kVga, kPartial));

TEST_P(DecisionOfBothSizes, OnlyWhatTheReferenceDoesNotSeeIsSent) {
  const BlockDecision decision = decide();
  EXPECT_TRUE(decision.from_preview);
  EXPECT_EQ(elsewhere(decision.send.colour, {}), 0);
  const int columns = static_cast<int>(camera.fx * kShift / 2.0) / kBlockSide;
  EXPECT_GE(decision.send.depth.count(), columns * decision.send.depth.grid().rows);
  EXPECT_TRUE(decision.send.depth == decision.send.colour) << "b has depth everywhere";
  EXPECT_EQ(decision.hidden + decision.recoloured, 0);
}

TEST_P(DecisionOfBothSizes, WhatHidesTheWallFromTheDependentIsSentWithDepth) {
  b.depth.counts(patch).setTo(1000);
  b.bgr(patch).setTo(cv::Scalar(10, 10, 200));
  const BlockDecision decision = decide();
  EXPECT_EQ(inside(decision.send.depth, patch), patch_blocks);
  EXPECT_EQ(decision.hidden, patch_blocks);
  EXPECT_EQ(elsewhere(decision.send.colour, around_patch), 0);
  EXPECT_EQ(elsewhere(decision.send.depth, patch), 0);
}

TEST_P(DecisionOfBothSizes, ExposureIsNoDifference) {
  b.bgr.convertTo(b.bgr, -1, 1.25, -12);
  const BlockDecision decision = decide();
  EXPECT_EQ(decision.recoloured, 0);
  EXPECT_EQ(elsewhere(decision.send.colour, {}), 0);
}

TEST_P(DecisionOfBothSizes, AnotherPosterIsSentInColourOnly) {
  b.bgr.convertTo(b.bgr, -1, 0.8, 20);
  b.bgr(patch).setTo(cv::Scalar(10, 250, 250));
  const BlockDecision decision = decide();
  EXPECT_EQ(inside(decision.send.colour, patch), patch_blocks);
  EXPECT_EQ(inside(decision.send.depth, patch), 0);
  EXPECT_EQ(elsewhere(decision.send.colour, around_patch), 0);
}

TEST_P(DecisionOfBothSizes, WhereTheDependentHasNoDepthNoneIsAskedFor) {
  b.depth.counts.setTo(0);
  const BlockDecision decision = decide();
  EXPECT_GT(decision.uncovered, 0);
  EXPECT_EQ(decision.send.depth.count(), 0);
}

TEST_P(DecisionOfBothSizes, LosslessDepthsAskForTheSameBlocks) {
  b.depth.counts(cv::Rect(300, 200, 64, 64)).setTo(700);
  b.depth.counts(patch).setTo(0);
  const BlockDecision rounded = decide();
  const BlockDecision exact = decide(make_exact_preview(b.depth, b.bgr));
  EXPECT_TRUE(exact.from_preview);
  EXPECT_GT(exact.hidden, 0);
  int different = 0;
  for (int block = 0; block < exact.send.depth.grid().count(); ++block) {
    different += exact.send.depth[block] != rounded.send.depth[block] ? 1 : 0;
  }
  EXPECT_LE(different, exact.send.depth.grid().count() / 100);
}

TEST_P(DecisionOfBothSizes, NoUsablePreviewIsThePapersPrediction) {
  const BlockMask paper = Predictor().predict(a.depth, camera, camera, right_by(kShift));
  Decider decider;
  BlockPreview other = make_preview(b.depth, b.bgr);
  other.grid = BlockGrid(camera.width + 8, camera.height);
  for (const BlockPreview* preview :
       {static_cast<const BlockPreview*>(nullptr), static_cast<const BlockPreview*>(&other)}) {
    const BlockDecision decision =
        decider.decide(a.depth, a.bgr, camera, camera, right_by(kShift), preview);
    EXPECT_FALSE(decision.from_preview);
    EXPECT_TRUE(decision.send.colour == paper);
    EXPECT_TRUE(decision.send.depth == paper);
  }
}

TEST_P(DecisionOfBothSizes, ReasonsAddUpAndDepthIsASubset) {
  b.depth.counts(patch).setTo(0);
  b.bgr(cv::Rect(200, 200, 64, 64)).setTo(cv::Scalar(0, 255, 0));
  b.depth.counts(cv::Rect(300, 200, 64, 64)).setTo(700);
  const BlockDecision decision = decide();
  EXPECT_EQ(decision.uncovered + decision.outside + decision.hidden + decision.recoloured,
            decision.send.colour.count());
  EXPECT_TRUE(is_subset(decision.send.depth, decision.send.colour));
  const BlockPreview preview = make_preview(b.depth, b.bgr);
  EXPECT_EQ(decision_picture(preview, decision.send).size(), b.bgr.size());
}

}  // namespace
}  // namespace rprr
