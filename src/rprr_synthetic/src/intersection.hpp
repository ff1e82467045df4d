// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rprr_synthetic/synthetic_scene.hpp"

namespace rprr {

constexpr float kNoHit = std::numeric_limits<float>::infinity();

/// A solid as seen from one place: rays start at `origin` (in the solid's frame) and their
/// directions are turned into the solid's frame.
struct PlacedPrimitive {
  Shape shape = Shape::box;
  Eigen::Matrix3f turn;    // local from the viewer's frame
  Eigen::Vector3f origin;  // viewer, local
  Eigen::Vector3f half;
};

inline PlacedPrimitive place(const Primitive& primitive, const Pose& world_from_viewer) {
  const Pose local_from_viewer = primitive.world_from_local.inverse() * world_from_viewer;
  return {primitive.shape, local_from_viewer.rotation().cast<float>(),
          local_from_viewer.translation().cast<float>(), primitive.half_size.cast<float>()};
}

inline float hit_box(const Eigen::Vector3f& o, const Eigen::Vector3f& d,
                     const Eigen::Vector3f& half) {
  float near = -kNoHit;
  float far = kNoHit;
  for (int i = 0; i < 3; ++i) {
    const float slope = std::abs(d[i]) > 1e-12f ? 1.0f / d[i] : std::copysign(1e12f, d[i]);
    const float t0 = (-half[i] - o[i]) * slope;
    const float t1 = (half[i] - o[i]) * slope;
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far && near > 0.0f ? near : kNoHit;
}

inline float hit_sphere(const Eigen::Vector3f& o, const Eigen::Vector3f& d, float radius) {
  const float a = d.squaredNorm();
  const float b = o.dot(d);
  const float root = b * b - a * (o.squaredNorm() - radius * radius);
  if (root < 0.0f) return kNoHit;
  const float t = (-b - std::sqrt(root)) / a;
  return t > 0.0f ? t : kNoHit;
}

inline float hit_cylinder(const Eigen::Vector3f& o, const Eigen::Vector3f& d,
                          const Eigen::Vector3f& half) {
  const float a = d.x() * d.x() + d.y() * d.y();
  const float b = o.x() * d.x() + o.y() * d.y();
  const float c = o.x() * o.x() + o.y() * o.y() - half.x() * half.x();
  const float root = b * b - a * c;
  if (root >= 0.0f && a > 1e-12f) {
    const float t = (-b - std::sqrt(root)) / a;
    if (t > 0.0f && std::abs(o.z() + t * d.z()) <= half.z()) return t;
  }
  if (std::abs(d.z()) < 1e-12f) return kNoHit;
  const float cap = (std::copysign(half.z(), -d.z()) - o.z()) / d.z();
  const float x = o.x() + cap * d.x();
  const float y = o.y() + cap * d.y();
  return cap > 0.0f && x * x + y * y <= half.x() * half.x() ? cap : kNoHit;
}

/// How often the direction goes into the way to the surface; kNoHit where it misses, and where the
/// ray starts inside.
inline float intersect(const PlacedPrimitive& primitive, const Eigen::Vector3f& direction) {
  const Eigen::Vector3f d = primitive.turn * direction;
  switch (primitive.shape) {
    case Shape::box:
      return hit_box(primitive.origin, d, primitive.half);
    case Shape::sphere:
      return hit_sphere(primitive.origin, d, primitive.half.x());
    case Shape::cylinder:
      return hit_cylinder(primitive.origin, d, primitive.half);
  }
  return kNoHit;
}

}  // namespace rprr
