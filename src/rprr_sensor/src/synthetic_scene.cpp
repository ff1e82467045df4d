// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/synthetic_scene.hpp"

#include <array>
#include <opencv2/core.hpp>

#include "intersection.hpp"
#include "renderer.hpp"

namespace rprr {
namespace {

constexpr int kShadowSide = 1024;

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
  for (int row = 0; row < kShadowSide; ++row) {
    auto* out = shadow_.ptr<float>(row);
    for (int column = 0; column < kShadowSide; ++column) {
      const Eigen::Vector3f direction = shadow_direction(column, row);
      float nearest = kNoHit;
      for (const auto& primitive : placed) {
        nearest = std::min(nearest, intersect(primitive, direction));
      }
      out[column] = nearest;
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
