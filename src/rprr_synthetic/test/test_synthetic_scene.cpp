// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_synthetic/synthetic_scene.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "rprr_geometry/relative_pose.hpp"
#include "rprr_synthetic/trajectory.hpp"

namespace rprr {
namespace {

const Camera kSceneCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

const Scene& room() {
  static const Scene scene = make_room(3);
  return scene;
}

Primitive at(Shape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
  Primitive primitive;
  primitive.shape = shape;
  primitive.world_from_local.translation() = centre;
  primitive.half_size = half;
  return primitive;
}

// With the identity as pose the camera looks along the world's z.
TEST(SyntheticScene, DepthOfEachShapeIsExact) {
  const Scene scene(
      {at(Shape::box, {0, 0, 5.5}, {9, 9, 0.5}), at(Shape::sphere, {-1.0, 0, 3.0}, {0.4, 0, 0}),
       at(Shape::cylinder, {1.0, 0, 3.0}, {0.3, 0.3, 0.5})},
      {0, 0, 4});
  const Camera camera{321, 241, 100, 100, 160, 120};
  const ExactView view = scene.render(camera, Pose::Identity());
  EXPECT_FLOAT_EQ(view.metres.at<float>(5, 5), 5.0f) << "depth runs along the axis, not the ray";
  EXPECT_FLOAT_EQ(view.metres.at<float>(235, 160), 5.0f);
  // Nearest cap of the cylinder, which stands along z: a disc of radius 0.3 at 2.5 m.
  EXPECT_FLOAT_EQ(view.metres.at<float>(120, 200), 2.5f);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < 150; ++u) {
      const float z = view.metres.at<float>(v, u);
      if (z > 4.0f) continue;
      const Eigen::Vector3d p = camera.unproject(u, v, z);
      ASSERT_NEAR((p - Eigen::Vector3d(-1, 0, 3)).norm(), 0.4, 1e-4) << u << "," << v;
    }
  }
}

TEST(SyntheticScene, CylinderSideIsExact) {
  Primitive pole = at(Shape::cylinder, {0, 0, 2.0}, {0.25, 0.25, 3.0});
  pole.world_from_local.linear() =
      Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const ExactView view = Scene({pole}, {0, 0, 0}).render(kSceneCamera, Pose::Identity());
  int seen = 0;
  for (int u = 0; u < kSceneCamera.width; ++u) {
    const float z = view.metres.at<float>(77, u);
    if (z == 0.0f) continue;
    const Eigen::Vector3d p = kSceneCamera.unproject(u, 77, z);
    ASSERT_NEAR(std::hypot(p.x(), p.z() - 2.0), 0.25, 1e-4);
    ++seen;
  }
  EXPECT_GT(seen, 50);
}

TEST(SyntheticScene, NothingBehindOrAroundTheCameraIsSeen) {
  const Scene scene(
      {at(Shape::box, {0, 0, -3}, {1, 1, 1}), at(Shape::sphere, {0, 0, 0}, {1, 0, 0})}, {0, 0, 4});
  const ExactView view = scene.render(kSceneCamera, Pose::Identity());
  EXPECT_EQ(cv::countNonZero(view.metres), 0);
}

TEST(SyntheticScene, TwoViewsAgreeWhereNothingHides) {
  for (const PairPose& pair : pair_walk(4, 11)) {
    const ExactView a = room().render(kSceneCamera, pair.a);
    const ExactView b = room().render(kSceneCamera, pair.b);
    const Pose b_from_a = relative_pose_of(pair.a, pair.b);
    int inside = 0;
    int agree = 0;
    int before = 0;  // a's point would stand in b's free sight: impossible
    for (int v = 0; v < kSceneCamera.height; v += 3) {
      for (int u = 0; u < kSceneCamera.width; u += 3) {
        const Eigen::Vector3d p =
            b_from_a * kSceneCamera.unproject(u, v, static_cast<double>(a.metres.at<float>(v, u)));
        if (p.z() < 0.1) continue;
        const Eigen::Vector2d pixel = kSceneCamera.project(p);
        if (!kSceneCamera.contains(pixel.x(), pixel.y())) continue;
        ++inside;
        // Around the pixel, since b has rays elsewhere.
        float low = 1e9f;
        float high = 0.0f;
        for (int dv = -1; dv <= 1; ++dv) {
          for (int du = -1; du <= 1; ++du) {
            const int row = std::clamp(static_cast<int>(std::lround(pixel.y())) + dv, 0, 239);
            const int column = std::clamp(static_cast<int>(std::lround(pixel.x())) + du, 0, 319);
            low = std::min(low, b.metres.at<float>(row, column));
            high = std::max(high, b.metres.at<float>(row, column));
          }
        }
        agree += p.z() > low - 0.002 && p.z() < high + 0.002 ? 1 : 0;
        before += p.z() < low - 0.01 ? 1 : 0;
      }
    }
    EXPECT_GT(inside, 3000);
    EXPECT_GT(agree, 0.88 * inside) << "of " << inside;
    EXPECT_LT(before, 0.01 * inside) << "of " << inside;
  }
}

TEST(SyntheticScene, SameSeedSameRoomSamePixels) {
  const Pose pose = single_walk(1, 3)[0];
  const ExactView one = room().render(kSceneCamera, pose);
  const ExactView two = make_room(3).render(kSceneCamera, pose);
  EXPECT_EQ(cv::norm(one.metres, two.metres, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(one.radiance, two.radiance, cv::NORM_INF), 0.0);
  const ExactView other = make_room(4).render(kSceneCamera, pose);
  EXPECT_GT(cv::norm(one.metres, other.metres, cv::NORM_INF), 0.1);
}

TEST(SyntheticScene, EveryViewOfTheRoomIsClosedAndTextured) {
  const std::vector<Pose> walk = single_walk(100, 8);
  for (std::size_t k = 0; k < walk.size(); k += 20) {
    const ExactView view = room().render(kSceneCamera, walk[k]);
    EXPECT_EQ(cv::countNonZero(view.metres), kSceneCamera.width * kSceneCamera.height)
        << "hole in the room";
    double nearest = 0.0;
    double farthest = 0.0;
    cv::minMaxLoc(view.metres, &nearest, &farthest);
    EXPECT_GT(nearest, 0.3) << "the camera walks into furniture, frame " << k;
    EXPECT_LT(farthest, 7.0);
    EXPECT_TRUE(cv::checkRange(view.radiance, true, nullptr, 0.0, 10.0));
    int flat = 0;
    int blocks = 0;
    for (int v = 0; v + 16 <= kSceneCamera.height; v += 16) {
      for (int u = 0; u + 16 <= kSceneCamera.width; u += 16, ++blocks) {
        cv::Scalar mean;
        cv::Scalar deviation;
        cv::meanStdDev(view.radiance(cv::Rect(u, v, 16, 16)), mean, deviation);
        flat += deviation[1] < 0.02 * mean[1] ? 1 : 0;
      }
    }
    EXPECT_LT(flat, blocks / 4) << "of " << blocks << " blocks, frame " << k;
  }
}

// What makes a corridor hard: depth stays as it is along it, colour does not.
TEST(SyntheticScene, ACorridorLooksTheSameToDepthAlongIt) {
  const Scene corridor = make_corridor(4);
  const ExactView here = corridor.render(kSceneCamera, look_along({0.0, 0.1, 1.3}, 0.5, -0.2, 0.0));
  const ExactView there =
      corridor.render(kSceneCamera, look_along({0.4, 0.1, 1.3}, 0.5, -0.2, 0.0));
  cv::Mat difference;
  cv::absdiff(here.metres, there.metres, difference);
  difference.setTo(0.0f, here.metres > 5.0f);
  EXPECT_LT(cv::countNonZero(difference > 0.02f), kSceneCamera.width * kSceneCamera.height / 200);
  cv::absdiff(here.radiance, there.radiance, difference);
  EXPECT_GT(cv::mean(difference)[1], 0.01);
}

}  // namespace
}  // namespace rprr
