// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_starts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "textured_views.hpp"

namespace rprr {
namespace {

PreviewView coarse_view(const Pose& b_from_a) {
  const RgbdFramePtr frame = textured_frame(b_from_a, 1, "x");
  return half_view(make_view(make_preview(frame->depth, frame->bgr, 0.003), kTestCamera));
}

// How far the nearest start is from the truth, degrees and metres at the scene's middle.
std::pair<double, double> nearest(const std::vector<Pose>& starts, const Pose& truth) {
  std::pair<double, double> best(1e9, 1e9);
  for (const Pose& start : starts) {
    const Eigen::Vector3d middle(0, 0, 2);
    const std::pair<double, double> off(rotation_error(start, truth),
                                        (start * middle - truth * middle).norm());
    if (off.first / 14.0 + off.second / 0.4 < best.first / 14.0 + best.second / 0.4) best = off;
  }
  return best;
}

TEST(PreviewStarts, OneIsNearTheTruthFromFarApart) {
  const PreviewView a = coarse_view(Pose::Identity());
  for (const auto& [metres, degrees] :
       {std::pair{0.0, 0.0}, {0.2, 10.0}, {0.5, -20.0}, {0.3, 30.0}, {0.8, 0.0}}) {
    const Pose b_from_a = test_motion(metres, degrees);
    const auto [turn, shift] = nearest(
        find_starts(CoarseMatch(coarse_view(b_from_a), a), StartRange()), b_from_a.inverse());
    EXPECT_LT(turn, 14.0) << metres << " m, " << degrees << " deg";
    EXPECT_LT(shift, 0.4) << metres << " m, " << degrees << " deg";
  }
}

TEST(PreviewStarts, AreDistinctAndNotMoreThanAskedFor) {
  const PreviewView a = coarse_view(Pose::Identity());
  StartRange range;
  range.starts = 12;
  const std::vector<Pose> starts =
      find_starts(CoarseMatch(coarse_view(test_motion(0.2, 10.0)), a), range);
  EXPECT_LE(starts.size(), 12u);
  ASSERT_GT(starts.size(), 1u);
  for (std::size_t i = 1; i < starts.size(); ++i) {
    EXPECT_GT(rotation_error(starts[i], starts[0]) +
                  (starts[i].translation() - starts[0].translation()).norm(),
              1e-3);
  }
}

TEST(PreviewStarts, OfViewsWithoutDepthThereAreStillRotations) {
  PreviewView blind = coarse_view(Pose::Identity());
  blind.z.assign(blind.size(), 0.0f);
  const std::vector<Pose> starts = find_starts(CoarseMatch(blind, blind), StartRange());
  for (const Pose& start : starts) EXPECT_TRUE(is_rigid(start));
}

}  // namespace
}  // namespace rprr
