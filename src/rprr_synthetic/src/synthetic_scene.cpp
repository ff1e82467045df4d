// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_synthetic/synthetic_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "intersection.hpp"
#include "renderer.hpp"

namespace rprr {
namespace {

constexpr int kShadowSide = 1024;
constexpr int kShadowTile = 32;

/// Directions from the lamp to a square and back: the lower half of an octahedral map. Coordinates
/// in pixels of the shadow image.
Eigen::Vector2f shadow_pixel(const Eigen::Vector3f& direction) {
  const Eigen::Vector3f p = direction / direction.lpNorm<1>();
  return Eigen::Vector2f(p.x() + p.y() + 1.0f, p.x() - p.y() + 1.0f) * (0.5f * kShadowSide) -
         Eigen::Vector2f::Constant(0.5f);
}

Eigen::Vector3f shadow_direction(int column, int row) {
  const float a = (static_cast<float>(column) + 0.5f) * (2.0f / kShadowSide) - 1.0f;
  const float b = (static_cast<float>(row) + 0.5f) * (2.0f / kShadowSide) - 1.0f;
  const float x = 0.5f * (a + b);
  const float y = 0.5f * (a - b);
  return Eigen::Vector3f(x, y, std::abs(x) + std::abs(y) - 1.0f).normalized();
}

/// Solids whose bounding sphere reaches into the cone round a tile of the shadow image.
std::vector<PlacedPrimitive> within_tile(const std::vector<PlacedPrimitive>& placed, int left,
                                         int top) {
  const int last = kShadowTile - 1;
  const Eigen::Vector3f axis = shadow_direction(left + kShadowTile / 2, top + kShadowTile / 2);
  float cone = 0.0f;  // [rad]
  for (const int row : {top, top + last}) {
    for (const int column : {left, left + last}) {
      const float cosine = std::min(axis.dot(shadow_direction(column, row)), 1.0f);
      cone = std::max(cone, std::acos(cosine));
    }
  }
  cone = 1.2f * cone + 0.01f;  // the corners are not quite the farthest
  std::vector<PlacedPrimitive> within;
  for (const auto& solid : placed) {
    const Eigen::Vector3f centre = solid.turn.transpose() * -solid.origin;
    const float distance = centre.norm();
    const float radius = solid.half.norm();
    const float off = std::acos(std::clamp(axis.dot(centre) / distance, -1.0f, 1.0f));
    if (distance <= radius || off < cone + std::asin(radius / distance)) within.push_back(solid);
  }
  return within;
}

/// Distance to the nearest solid in every direction of a tile.
void bake_tile(const std::vector<PlacedPrimitive>& solids, int left, int top, cv::Mat& tile) {
  for (int row = 0; row < tile.rows; ++row) {
    for (int column = 0; column < tile.cols; ++column) {
      const Eigen::Vector3f direction = shadow_direction(left + column, top + row);
      float nearest = kNoHit;
      for (const auto& solid : solids) nearest = std::min(nearest, intersect(solid, direction));
      tile.at<float>(row, column) = nearest;
    }
  }
}

/// Light that does not come from the lamp: sky-like from above, a little from one side.
float ambient(const Eigen::Vector3f& normal) {
  return 0.24f + 0.08f * normal.z() + 0.05f * normal.x() - 0.03f * normal.y();
}

}  // namespace

Scene::Scene(std::vector<Primitive> primitives, const Eigen::Vector3d& lamp)
    : primitives_(std::move(primitives)), lamp_(lamp.cast<float>()) {
  bake_shadows();
}

void Scene::bake_shadows() {
  Pose world_from_lamp = Pose::Identity();
  world_from_lamp.translation() = lamp_.cast<double>();
  std::vector<PlacedPrimitive> placed;
  for (const auto& primitive : primitives_) placed.push_back(place(primitive, world_from_lamp));
  shadow_.create(kShadowSide, kShadowSide, CV_32FC1);
  for (int top = 0; top < kShadowSide; top += kShadowTile) {
    for (int left = 0; left < kShadowSide; left += kShadowTile) {
      cv::Mat tile = shadow_(cv::Rect(left, top, kShadowTile, kShadowTile));
      bake_tile(within_tile(placed, left, top), left, top, tile);
    }
  }
}

float Scene::lamp_visibility(const Eigen::Vector3f& world) const {
  const Eigen::Vector3f ray = world - lamp_;
  if (ray.z() > -0.05f) return 1.0f;  // beside or above the lamp
  const float limit = ray.norm() - 0.03f;
  const Eigen::Vector2f centre = shadow_pixel(ray);
  static constexpr std::array<std::array<float, 2>, 12> kTaps = {{{-0.9f, -0.3f},
                                                                  {-0.5f, 0.7f},
                                                                  {0.1f, -0.9f},
                                                                  {0.9f, 0.2f},
                                                                  {0.4f, 0.8f},
                                                                  {-0.2f, 0.2f},
                                                                  {0.5f, -0.4f},
                                                                  {-0.6f, -0.8f},
                                                                  {0.2f, 0.3f},
                                                                  {-0.9f, 0.3f},
                                                                  {0.8f, -0.7f},
                                                                  {-0.2f, -0.4f}}};
  constexpr float kRadius = 4.5f;
  int lit = 0;
  for (const auto& tap : kTaps) {
    const int column = static_cast<int>(centre.x() + kRadius * tap[0] + 0.5f);
    const int row = static_cast<int>(centre.y() + kRadius * tap[1] + 0.5f);
    const float distance = shadow_.at<float>(std::clamp(row, 0, kShadowSide - 1),
                                             std::clamp(column, 0, kShadowSide - 1));
    lit += distance > limit ? 1 : 0;
  }
  return static_cast<float>(lit) / static_cast<float>(kTaps.size());
}

float Scene::light(const Eigen::Vector3f& world, const Eigen::Vector3f& normal) const {
  const Eigen::Vector3f to_lamp = lamp_ - world;
  const float facing = normal.dot(to_lamp) / to_lamp.norm();
  const float around = ambient(normal);
  if (facing <= 0.0f) return around;
  return around + lamp_visibility(world) * facing * 3.8f / (1.0f + to_lamp.squaredNorm());
}

ExactView Scene::render(const Camera& camera, const Pose& world_from_camera) const {
  return Renderer(*this, camera, world_from_camera).render();
}

}  // namespace rprr
