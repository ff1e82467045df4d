// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/synthetic_scene.hpp"

#include <array>
#include <opencv2/core.hpp>

#include "intersection.hpp"
#include "screen_tiles.hpp"
#include "texture.hpp"

namespace rprr {
namespace {

constexpr int kShadowSide = 1024;

struct Surface {
  Eigen::Vector3f normal;  // in the solid's frame
  SurfacePoint point;
};

Surface flatten_box(const Eigen::Vector3f& p, const Eigen::Vector3f& half) {
  int axis = 0;
  (p.array().abs() - half.array()).maxCoeff(&axis);
  const bool front = p[axis] > 0.0f;
  Surface s;
  s.normal = Eigen::Vector3f::Zero();
  s.normal[axis] = front ? 1.0f : -1.0f;
  const int u = axis == 0 ? 1 : 0;
  const int v = axis == 2 ? 1 : 2;
  // Seen from outside u runs to the right, so that letters are not mirrored.
  const bool mirrored = (axis == 1) == front;
  s.point = {mirrored ? -p[u] : p[u],
             p[v],
             half[u],
             half[v],
             0.0f,
             static_cast<std::uint32_t>(2 * axis + (front ? 1 : 0))};
  return s;
}

Surface flatten_sphere(const Eigen::Vector3f& p, float radius) {
  Surface s;
  s.normal = p / radius;
  const float round = 3.14159265f * radius;
  s.point = {std::atan2(p.y(), p.x()) * radius,
             std::asin(std::clamp(p.z() / radius, -1.0f, 1.0f)) * radius,
             round,
             0.5f * round,
             0.0f,
             0};
  return s;
}

Surface flatten_cylinder(const Eigen::Vector3f& p, const Eigen::Vector3f& half) {
  Surface s;
  if (half.z() - std::abs(p.z()) < 1e-5f) {
    s.normal = {0.0f, 0.0f, std::copysign(1.0f, p.z())};
    s.point = {p.x(), p.y(), half.x(), half.x(), 0.0f, 1};
  } else {
    s.normal = Eigen::Vector3f(p.x(), p.y(), 0.0f).normalized();
    s.point = {
        std::atan2(p.y(), p.x()) * half.x(), p.z(), 3.14159265f * half.x(), half.z(), 0.0f, 0};
  }
  return s;
}

Surface flatten(const PlacedPrimitive& primitive, const Eigen::Vector3f& local) {
  switch (primitive.shape) {
    case Shape::sphere:
      return flatten_sphere(local, primitive.half.x());
    case Shape::cylinder:
      return flatten_cylinder(local, primitive.half);
    case Shape::box:
      break;
  }
  return flatten_box(local, primitive.half);
}

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

ExactView Scene::render(const Camera& camera, const Pose& world_from_camera) const {
  std::vector<PlacedPrimitive> placed;
  for (const auto& primitive : primitives_) placed.push_back(place(primitive, world_from_camera));
  const ScreenTiles tiles(placed, camera);
  const Eigen::Matrix3f world_turn = world_from_camera.rotation().cast<float>();
  const Eigen::Vector3f eye = world_from_camera.translation().cast<float>();

  ExactView view;
  view.metres = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  view.radiance = cv::Mat::zeros(camera.height, camera.width, CV_32FC3);
  view.infrared = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      // With z = 1 the ray parameter is the depth.
      const Eigen::Vector3f ray = camera.unproject(u, v, 1.0).cast<float>();
      const auto [index, z] = tiles.first_hit(u, v, ray);
      if (index < 0) continue;
      const auto& hit = placed[static_cast<std::size_t>(index)];
      const auto& material = primitives_[static_cast<std::size_t>(index)].material;
      Surface surface = flatten(hit, hit.origin + z * (hit.turn * ray));
      const Eigen::Vector3f normal = hit.turn.transpose() * surface.normal;  // camera's frame
      const float cosine = std::abs(normal.dot(ray)) / ray.norm();
      surface.point.footprint =
          z / static_cast<float>(camera.fx) / std::sqrt(std::max(cosine, 0.05f));

      const Eigen::Vector3f world = eye + world_turn * (z * ray);
      const Eigen::Vector3f world_normal = world_turn * normal;
      const Eigen::Vector3f to_lamp = lamp_ - world;
      const float facing = world_normal.dot(to_lamp) / to_lamp.norm();
      float light = ambient(world_normal);
      if (facing > 0.0f) {
        light += lamp_visibility(world) * facing * 3.0f / (1.0f + to_lamp.squaredNorm());
      }
      const Eigen::Vector3f colour = (light * albedo(material, surface.point)).cwiseMax(0.0f);
      view.metres.at<float>(v, u) = z;
      view.radiance.at<cv::Vec3f>(v, u) = {colour[0], colour[1], colour[2]};
      view.infrared.at<float>(v, u) = cosine * material.infrared;
    }
  }
  return view;
}

}  // namespace rprr
