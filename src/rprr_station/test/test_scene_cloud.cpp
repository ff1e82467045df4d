// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/block_mask.hpp"
#include "rprr_station/scene_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <random>
#include <utility>

namespace rprr {
namespace {

const Camera kCloudCamera{160, 120, 140, 140, 79.5, 59.5};
constexpr double kWall = 2.0;      // metres before the reference
constexpr double kScreen = 1.2;    // a screen before the wall ...
constexpr double kScreenTo = 0.1;  // ... left of this

// A frame of a wall, and perhaps a screen, square to the reference's axis, with a Kinect's noise.
// motion: from the reference.
RebuiltFrame view_of_wall(const std::string& robot, const Pose& b_from_a, bool screen,
                          unsigned seed) {
  RebuiltFrame frame;
  frame.robot = robot;
  frame.frame_id = robot + "_rgb_optical_frame";
  frame.camera = kCloudCamera;
  frame.b_from_a = b_from_a;
  frame.depth.unit = 0.001;
  frame.depth.counts.create(kCloudCamera.height, kCloudCamera.width, CV_16UC1);
  frame.bgr = cv::Mat(frame.depth.counts.size(), CV_8UC3, cv::Scalar(1, 2, 3));
  frame.received_depth = BlockMask(BlockGrid(kCloudCamera.width, kCloudCamera.height), true);
  const Pose to_reference = b_from_a.inverse();
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  for (int v = 0; v < kCloudCamera.height; ++v) {
    for (int u = 0; u < kCloudCamera.width; ++u) {
      const Eigen::Vector3d ray = to_reference.linear() * kCloudCamera.unproject(u, v, 1.0);
      const Eigen::Vector3d eye = to_reference.translation();
      double z = (kWall - eye.z()) / ray.z();
      const double z_screen = (kScreen - eye.z()) / ray.z();
      if (screen && eye.x() + z_screen * ray.x() < kScreenTo) z = z_screen;
      frame.depth.counts.at<std::uint16_t>(v, u) =
          static_cast<std::uint16_t>(std::lround(1000 * (z + depth_sigma(z) * noise(random))));
    }
  }
  return frame;
}

RebuiltFrame reference(bool screen = false) {
  RebuiltFrame frame = view_of_wall("a", Pose::Identity(), screen, 1);
  frame.stamp = 77;
  return frame;
}

RebuiltFrame dependent(const Pose& b_from_a, bool screen = false, const std::string& robot = "b") {
  RebuiltFrame frame = view_of_wall(robot, b_from_a, screen, 2);
  frame.sparse = true;
  frame.stamp = 78;
  frame.reference = "a";
  frame.reference_stamp = 77;
  return frame;
}

// The dependent stands so far to the right of the reference and is turned to the left (positive):
// then points in its frame are what this does to those in the reference's.
Pose stand(double right, double turn) {
  Pose pose = Pose::Identity();  // of the dependent, in the reference's frame
  pose.translation() = Eigen::Vector3d(right, 0, 0);
  pose.linear() = Eigen::AngleAxisd(-turn, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return pose.inverse();
}

// How many points lie over each cell of the wall's plane, of 5 cm.
std::map<std::pair<int, int>, int> cells(const Scene& scene) {
  std::map<std::pair<int, int>, int> counts;
  for (const ScenePoint& point : scene.points) {
    ++counts[{static_cast<int>(std::floor(point.position.x() / 0.05f)),
              static_cast<int>(std::floor(point.position.y() / 0.05f))}];
  }
  return counts;
}

bool well_inside_reference(const ScenePoint& point) {
  const Eigen::Vector2d at = kCloudCamera.project(point.position.cast<double>());
  return at.x() > 1 && at.y() > 1 && at.x() < kCloudCamera.width - 2 &&
         at.y() < kCloudCamera.height - 2;
}

Scene scene_of(SceneCloud& cloud) {
  Scene scene;
  cloud.make(scene);
  return scene;
}

TEST(SceneCloud, NoSurfaceIsThereTwice) {
  SceneCloud cloud;
  EXPECT_FALSE(cloud.add(reference())) << "nothing to join yet";
  const std::size_t alone = reference().depth.counts.total();
  ASSERT_TRUE(cloud.add(dependent(stand(0.5, 0.2))));
  const Scene scene = scene_of(cloud);
  std::size_t inside = 0;
  for (std::size_t i = alone; i < scene.points.size(); ++i) {
    inside += well_inside_reference(scene.points[i]) ? 1 : 0;
  }
  EXPECT_EQ(inside, 0U) << "the reference sees the wall there itself";
  EXPECT_GT(scene.points.size(), alone + 1000) << "the dependent sees more of the wall";
  Scene before;
  before.points.assign(scene.points.begin(), scene.points.begin() + static_cast<long>(alone));
  int most = 0;
  for (const auto& [cell, count] : cells(before)) most = std::max(most, count);
  for (const auto& [cell, count] : cells(scene)) {
    EXPECT_LE(count, 2 * most) << "at cell " << cell.first << ", " << cell.second;
  }
}

TEST(SceneCloud, NewPointsLieWhereTheDependentLooks) {
  for (const double side : {1.0, -1.0}) {
    SceneCloud cloud;
    cloud.add(reference());
    ASSERT_TRUE(cloud.add(dependent(stand(side * 0.5, 0.0))));
    const Scene scene = scene_of(cloud);
    const std::size_t alone = reference().depth.counts.total();
    ASSERT_GT(scene.points.size(), alone);
    for (std::size_t i = alone; i < scene.points.size(); ++i) {
      EXPECT_GT(side * scene.points[i].position.x(), 1.0) << "to the side where it stands";
      EXPECT_NEAR(scene.points[i].position.z(), kWall, 0.05) << "on the wall";
    }
  }
}

TEST(SceneCloud, WhatTheReferenceHasNoneOfIsAdded) {
  SceneCloud cloud;
  cloud.add(reference(/*screen=*/true));
  ASSERT_TRUE(cloud.add(dependent(stand(0.6, 0.3), /*screen=*/true)));
  const Scene scene = scene_of(cloud);
  const std::size_t alone = reference().depth.counts.total();
  int behind = 0;
  for (std::size_t i = alone; i < scene.points.size(); ++i) {
    const ScenePoint& point = scene.points[i];
    behind += well_inside_reference(point) && point.position.z() > 1.8 ? 1 : 0;
    EXPECT_FALSE(well_inside_reference(point) && point.position.z() < 1.3)
        << "both see the screen: " << point.position.transpose();
  }
  EXPECT_GT(behind, 100) << "the wall in the screen's shadow";
}

TEST(SceneCloud, DepthThatCameFromTheReferenceIsNotAdded) {
  SceneCloud cloud;
  cloud.add(reference());
  RebuiltFrame frame = dependent(stand(0.5, 0.0));
  const BlockGrid grid(kCloudCamera.width, kCloudCamera.height);
  frame.received_depth = BlockMask(grid);
  ASSERT_TRUE(cloud.add(frame));
  const std::size_t alone = reference().depth.counts.total();
  EXPECT_EQ(scene_of(cloud).points.size(), alone) << "all of it is predicted";
  frame.received_depth.set(grid.index(grid.columns - 1, 3));
  ASSERT_TRUE(cloud.add(frame));
  EXPECT_EQ(scene_of(cloud).points.size(), alone + 64) << "one block is received";
}

TEST(SceneCloud, DependentsDoNotDoubleEachOther) {
  SceneCloud cloud;
  cloud.add(reference());
  ASSERT_TRUE(cloud.add(dependent(stand(0.5, 0.0))));
  const std::size_t with_b = scene_of(cloud).points.size();
  ASSERT_TRUE(cloud.add(dependent(stand(0.5, 0.0), false, "c")));
  EXPECT_EQ(scene_of(cloud).points.size(), with_b) << "c sees what b sees";
  ASSERT_TRUE(cloud.add(dependent(stand(-0.5, 0.0), false, "c")));
  EXPECT_GT(scene_of(cloud).points.size(), with_b) << "c's later frame replaces the one before";
}

TEST(SceneCloud, TheSceneIsTheReferences) {
  SceneCloud cloud;
  cloud.add(reference());
  cloud.add(dependent(stand(0.1, 0.0)));
  const Scene scene = scene_of(cloud);
  EXPECT_EQ(scene.robot, "a");
  EXPECT_EQ(scene.frame_id, "a_rgb_optical_frame");
  EXPECT_EQ(scene.stamp, 77);
}

TEST(SceneCloud, StaysWithinItsBounds) {
  SceneCloudOptions options;
  options.references = 2;
  options.most_points = 3000;
  SceneCloud cloud(options);
  cloud.add(reference());
  ASSERT_TRUE(cloud.add(dependent(stand(0.5, 0.0))));
  const Scene scene = scene_of(cloud);
  EXPECT_LE(scene.points.size(), 3000U);
  EXPECT_GT(scene.points.size(), 1000U);
  for (int i = 0; i < 2; ++i) {
    RebuiltFrame next = reference();
    next.stamp = 100 + i;
    cloud.add(next);
  }
  EXPECT_FALSE(cloud.add(dependent(stand(0.5, 0.0)))) << "its reference was given up";
  EXPECT_TRUE(scene_of(cloud).points.empty());
}

TEST(SceneCloud, RefusesWhatDoesNotFit) {
  SceneCloud cloud;
  EXPECT_FALSE(cloud.add(dependent(stand(0.1, 0.0)))) << "no reference";
  cloud.add(reference());
  RebuiltFrame frame = dependent(stand(0.1, 0.0));
  frame.received_depth = BlockMask();
  EXPECT_FALSE(cloud.add(frame)) << "no block mask";
  frame = dependent(stand(0.1, 0.0));
  frame.depth.counts = frame.depth.counts(cv::Rect(0, 0, 80, 60));
  EXPECT_FALSE(cloud.add(frame)) << "depth of another size";
  frame = dependent(stand(0.1, 0.0));
  frame.b_from_a.linear() *= 2;
  EXPECT_FALSE(cloud.add(frame)) << "no rigid motion";
  cloud.clear();
  EXPECT_FALSE(cloud.add(dependent(stand(0.1, 0.0)))) << "everything is forgotten";
}

}  // namespace
}  // namespace rprr
