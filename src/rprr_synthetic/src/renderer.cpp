// SPDX-License-Identifier: BSD-3-Clause
#include "renderer.hpp"

#include <opencv2/core.hpp>

#include "texture.hpp"

namespace rprr {
namespace {

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

std::vector<PlacedPrimitive> place_all(const Scene& scene, const Pose& world_from_camera) {
  std::vector<PlacedPrimitive> placed;
  for (const auto& primitive : scene.primitives()) {
    placed.push_back(place(primitive, world_from_camera));
  }
  return placed;
}

cv::Vec3f to_pixel(const Eigen::Vector3f& colour) {
  return {colour[0], colour[1], colour[2]};
}

}  // namespace

Renderer::Renderer(const Scene& scene, const Camera& camera, const Pose& world_from_camera)
    : scene_(scene),
      camera_(camera),
      world_turn_(world_from_camera.rotation().cast<float>()),
      eye_(world_from_camera.translation().cast<float>()),
      placed_(place_all(scene, world_from_camera)),
      tiles_(placed_, camera) {
}

Renderer::Hit Renderer::trace(int u, int v, double du, double dv) const {
  // With z = 1 the ray's parameter is the depth.
  const Eigen::Vector3f ray = camera_.unproject(u + du, v + dv, 1.0).cast<float>();
  const auto [index, z] = tiles_.first_hit(u, v, ray);
  if (index < 0) return {};
  const PlacedPrimitive& solid = placed_[static_cast<std::size_t>(index)];
  const Material& material = scene_.primitives()[static_cast<std::size_t>(index)].material;
  Surface surface = flatten(solid, solid.origin + z * (solid.turn * ray));
  const Eigen::Vector3f normal = solid.turn.transpose() * surface.normal;  // camera's frame
  const float cosine = std::abs(normal.dot(ray)) / ray.norm();
  surface.point.footprint = z / static_cast<float>(camera_.fx) / std::sqrt(std::max(cosine, 0.05f));
  const float light = scene_.light(eye_ + world_turn_ * (z * ray), world_turn_ * normal);
  return {index, z, cosine * material.infrared,
          (light * albedo(material, surface.point)).cwiseMax(0.0f)};
}

ExactView Renderer::render() const {
  ExactView view;
  view.metres.create(camera_.height, camera_.width, CV_32FC1);
  view.radiance.create(camera_.height, camera_.width, CV_32FC3);
  view.infrared.create(camera_.height, camera_.width, CV_32FC1);
  cv::Mat primitives(camera_.height, camera_.width, CV_32SC1);
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      const Hit hit = trace(u, v, 0.0, 0.0);
      view.metres.at<float>(v, u) = hit.metres;
      view.infrared.at<float>(v, u) = hit.infrared;
      view.radiance.at<cv::Vec3f>(v, u) = to_pixel(hit.radiance);
      primitives.at<int>(v, u) = hit.primitive;
    }
  }
  smooth_edges(primitives, view.radiance);
  return view;
}

void Renderer::smooth_edges(const cv::Mat& primitives, cv::Mat& radiance) const {
  for (int v = 1; v + 1 < camera_.height; ++v) {
    const int* above = primitives.ptr<int>(v - 1);
    const int* here = primitives.ptr<int>(v);
    const int* below = primitives.ptr<int>(v + 1);
    for (int u = 1; u + 1 < camera_.width; ++u) {
      const int solid = here[u];
      if (here[u - 1] == solid && here[u + 1] == solid && above[u] == solid && below[u] == solid) {
        continue;
      }
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const double du : {-0.25, 0.25}) {
        for (const double dv : {-0.25, 0.25}) sum += trace(u, v, du, dv).radiance;
      }
      radiance.at<cv::Vec3f>(v, u) = to_pixel(0.25f * sum);
    }
  }
}

}  // namespace rprr
