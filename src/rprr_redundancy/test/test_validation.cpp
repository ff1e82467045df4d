// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/validation.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

#include "plane_views.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_redundancy/prediction.hpp"

namespace rprr {
namespace {

// The definition, pixel by pixel.
BlockMask by_definition(const DepthFrame& b, const Camera& b_camera, const Camera& a_camera,
                        const Pose& b_from_a, int min_pixels) {
  const BlockGrid grid(b_camera.width, b_camera.height);
  std::vector<int> outside(static_cast<std::size_t>(grid.count()), 0);
  for (int v = 0; v < grid.height; ++v) {
    for (int u = 0; u < grid.width; ++u) {
      const double z = b.metres(u, v);
      if (z == 0) continue;
      const Eigen::Vector3d p = b_from_a.inverse() * b_camera.unproject(u, v, z);
      const bool seen =
          p.z() >= 0.05 && a_camera.contains(a_camera.project(p).x(), a_camera.project(p).y());
      if (!seen) ++outside[static_cast<std::size_t>(grid.index_of_pixel(u, v))];
    }
  }
  BlockMask mask(grid);
  for (int i = 0; i < grid.count(); ++i) {
    mask.set(i, outside[static_cast<std::size_t>(i)] >= min_pixels);
  }
  return mask;
}

TEST(Validation, IdentityFindsNothing) {
  for (const Camera& camera : {kVga, kPartial}) {
    const BlockMask mask =
        Validator().validate(plane(camera, 2000), camera, camera, Pose::Identity());
    EXPECT_EQ(mask.grid().width, camera.width);
    EXPECT_EQ(mask.count(), 0);
  }
}

// The paper's Fig. occlusion: a cylinder before b that stands outside of a's field of view. a's
// prediction covers that region with background; only b can know.
TEST(Validation, OccluderOutsideOfTheReferencesViewIsFound) {
  const Pose b_from_a = shift(0.5, 0, 0);  // b stands 0.5 m to the left of a
  const BlockGrid grid(kVga.width, kVga.height);
  DepthFrame b = plane(kVga, 4000);
  // At 0.6 m and column 160..200 of b: x = -0.16 m before b, -0.66 m before a, outside its view.
  b.counts(cv::Rect(160, 160, 40, 160)).setTo(600);
  const BlockMask predicted = Predictor().predict(plane(kVga, 4000), kVga, kVga, b_from_a);
  const BlockMask validated = Validator().validate(b, kVga, kVga, b_from_a);
  for (int row = 20; row < 40; ++row) {
    for (int column = 20; column < 25; ++column) {
      EXPECT_FALSE(predicted[grid.index(column, row)]) << "a takes it for background";
      EXPECT_TRUE(validated[grid.index(column, row)]) << "b knows better";
    }
    EXPECT_FALSE(validated[grid.index(26, row)]) << "background that a sees";
  }
}

TEST(Validation, SurfaceBehindTheReferenceIsFound) {
  const int all = BlockGrid(640, 480).count();
  EXPECT_EQ(Validator().validate(plane(kVga, 1000), kVga, kVga, shift(0, 0, 2)).count(), all);
}

TEST(Validation, PixelsWithoutDepthDoNotCount) {
  EXPECT_EQ(Validator().validate(plane(kVga, 0), kVga, kVga, shift(0, 0, 2)).count(), 0);
  EXPECT_EQ(Validator().validate({}, kVga, kVga, shift(0, 0, 2)).count(), 0);
  EXPECT_EQ(Validator().validate(plane(kPartial, 1000), kVga, kVga, shift(0, 0, 2)).count(), 0);
}

TEST(Validation, MinPixelsAsksForThatMany) {
  DepthFrame b = plane(kVga, 0);
  b.counts(cv::Rect(16, 16, 3, 1)).setTo(1000);
  const Pose behind = shift(0, 0, 2);
  EXPECT_EQ(Validator({3}).validate(b, kVga, kVga, behind).count(), 1);
  EXPECT_EQ(Validator({4}).validate(b, kVga, kVga, behind).count(), 0);
  EXPECT_EQ(Validator({0}).validate(b, kVga, kVga, behind).count(), 1) << "0 means 1";
}

TEST(Validation, AgreesWithTheDefinitionOnRandomSurfaces) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> depth(0, 9000);
  Validator validator({2});
  for (int trial = 0; trial < 4; ++trial) {
    DepthFrame b = plane(kPartial, 0);
    for (int i = 0; i < 20; ++i) {
      cv::Rect box(static_cast<int>(random() % 480), static_cast<int>(random() % 300), 60, 60);
      b.counts(box).setTo(depth(random));
    }
    Twist twist;
    twist << 0.3, -0.2, 0.4, 0.1, -0.2, 0.05 * trial;
    const Pose b_from_a = exp_se3(twist);
    const BlockMask expected = by_definition(b, kPartial, kVga, b_from_a, 2);
    const BlockMask found = validator.validate(b, kPartial, kVga, b_from_a);
    int different = 0;
    for (int i = 0; i < expected.grid().count(); ++i) different += expected[i] != found[i];
    EXPECT_LE(different, 2) << "float rounding at the rim aside, of " << expected.count();
    EXPECT_GT(expected.count(), 0);
  }
}

}  // namespace
}  // namespace rprr
