// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_alignment.hpp"

#include <gtest/gtest.h>

#include "rprr_pose/preview_agreement.hpp"
#include "textured_views.hpp"

namespace rprr {
namespace {

PreviewView view_of(const Pose& b_from_a, double exposure = 1.0) {
  const RgbdFramePtr frame = textured_frame(b_from_a, 1, "x", exposure);
  return make_view(make_preview(frame->depth, frame->bgr, 0.001), kTestCamera);
}

TEST(PreviewView, CellsLieOnTheSurfaceWithItsNormal) {
  const PreviewView view = view_of(Pose::Identity());
  EXPECT_EQ(view.width(), 40);
  EXPECT_EQ(view.height(), 30);
  int checked = 0;
  for (std::size_t i = 0; i < view.size(); i += 7) {
    if (view.nx[i] == 0.0f && view.ny[i] == 0.0f && view.nz[i] == 0.0f) continue;
    const Eigen::Vector3d ray(view.x[i] / view.z[i], view.y[i] / view.z[i], 1.0);
    if (std::abs(corner_depth(Eigen::Vector3d::Zero(), ray) - view.z[i]) > 0.05) continue;
    EXPECT_LT(view.nx[i] * view.x[i] + view.ny[i] * view.y[i] + view.nz[i] * view.z[i], 0.0f)
        << "normals point to the camera";
    ++checked;
  }
  EXPECT_GT(checked, 80);
}

TEST(PreviewView, HalfOfAViewIsTheSameSceneMoreCoarsely) {
  const PreviewView view = view_of(Pose::Identity());
  const PreviewView half = half_view(view);
  EXPECT_EQ(half.width(), 20);
  const Agreement same = agreement(half, view, Pose::Identity());
  EXPECT_GT(same.consistent, 0.9 * same.in_view);
  EXPECT_GT(same.correlation, 0.95);
}

TEST(PreviewAlignment, StepsTowardsTheTruth) {
  const Pose truth = test_motion(0.06, 3.0);
  const PreviewView a = view_of(Pose::Identity());
  const PreviewView b = view_of(truth, 0.8);
  FixedView fixed;
  fixed.cells = &a;
  AlignmentOptions options;
  options.iterations = 15;
  Pose b_to_a = Pose::Identity();
  AlignmentSums sums;
  ASSERT_TRUE(align(points_of(b, 1), fixed, options, b_to_a, sums));
  EXPECT_LT(translation_error(b_to_a.inverse(), truth), 0.03);
  EXPECT_GT(sums.correlation, 0.9);
  EXPECT_GT(sums.score(), 0.5);
}

TEST(PreviewAlignment, NothingInCommonIsLost) {
  const PreviewView a = view_of(Pose::Identity());
  FixedView fixed;
  fixed.cells = &a;
  Pose away = test_motion(0.0, 170.0);
  AlignmentSums sums;
  EXPECT_FALSE(align(points_of(a, 1), fixed, {}, away, sums));
}

TEST(PreviewAlignment, LumaResidualsSetTheirOwnSpread) {
  const PreviewView a = view_of(Pose::Identity());
  FixedView fixed;
  fixed.cells = &a;
  const auto sigma_of = [&](double exposure, float noise) {
    PreviewView b = view_of(Pose::Identity(), exposure);
    for (std::size_t i = 0; i < b.size(); ++i) b.luma[i] += (i % 2 == 0 ? noise : -noise);
    Pose fixed_from_moving = Pose::Identity();
    AlignmentSums sums;
    AlignmentOptions options;
    EXPECT_TRUE(align(points_of(b, 1), fixed, options, fixed_from_moving, sums));
    return sums.luma_sigma;
  };
  EXPECT_DOUBLE_EQ(sigma_of(0.9, 0.0f), 5.0) << "never below its floor";
  EXPECT_GT(sigma_of(0.9, 12.0f), 10.0);
  EXPECT_DOUBLE_EQ(sigma_of(0.9, 60.0f), 20.0) << "never above its ceiling";
}

TEST(MovingPoints, AreEveryStridethCellWithDepthInAStaggeredPattern) {
  PreviewView view = view_of(Pose::Identity());
  std::fill(view.z.begin(), view.z.end(), 1.0f);
  EXPECT_EQ(points_of(view, 1).size(), view.size());
  for (const int stride : {2, 3, 4}) {
    const MovingPoints points = points_of(view, stride);
    EXPECT_NEAR(static_cast<double>(points.size()), static_cast<double>(view.size()) / stride,
                30.0);
    EXPECT_EQ(points.luma.size(), points.size());
  }
  view.z.assign(view.size(), 0.0f);
  EXPECT_EQ(points_of(view, 2).size(), 0u);
}

TEST(Agreement, FallsWithTheError) {
  const Pose truth = test_motion(0.1, 5.0);
  const PreviewView a = view_of(Pose::Identity());
  const PreviewView b = view_of(truth);
  const Agreement right = agreement(a, b, truth);
  const Agreement wrong = agreement(a, b, test_motion(-0.3, -8.0));
  EXPECT_GT(right.consistent, 0.9 * right.in_view);
  EXPECT_GT(right.fine_correlation, 0.5);
  EXPECT_LT(wrong.consistent + 2 * wrong.in_view / 10, right.consistent);
  EXPECT_LT(wrong.fine_correlation, right.fine_correlation);
}

}  // namespace
}  // namespace rprr
