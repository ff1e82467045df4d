// SPDX-License-Identifier: BSD-3-Clause
#include "screen_tiles.hpp"

namespace rprr {
namespace {

// Nothing nearer than this is drawn exactly at the image's border.
constexpr float kNearPlane = 0.02f;

struct Bounds {
  float left = kNoHit, top = kNoHit, right = -kNoHit, bottom = -kNoHit;  // [px]
  float nearest = kNoHit;                                                // [m]

  void add(const Eigen::Vector3f& p, const Camera& camera) {
    const Eigen::Vector2d pixel = camera.project(p.cast<double>());
    left = std::min(left, static_cast<float>(pixel.x()));
    right = std::max(right, static_cast<float>(pixel.x()));
    top = std::min(top, static_cast<float>(pixel.y()));
    bottom = std::max(bottom, static_cast<float>(pixel.y()));
    nearest = std::min(nearest, p.z());
  }
};

/// The bounds on the screen of a solid's bounding box, as far as it lies beyond the near plane. The
/// box's edges, cut off at that plane, span its whole outline.
Bounds bounds_of(const PlacedPrimitive& solid, const Camera& camera) {
  Eigen::Vector3f half = solid.half;
  if (solid.shape == Shape::sphere) half.setConstant(half.x());
  if (solid.shape == Shape::cylinder) half.y() = half.x();
  Eigen::Vector3f corners[8];
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f sign(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f);
    corners[i] = solid.turn.transpose() * (sign.cwiseProduct(half) - solid.origin);
  }
  Bounds bounds;
  for (int i = 0; i < 8; ++i) {
    if (corners[i].z() >= kNearPlane) bounds.add(corners[i], camera);
    for (const int bit : {1, 2, 4}) {
      const Eigen::Vector3f& from = corners[i];
      const Eigen::Vector3f& to = corners[i ^ bit];
      if (from.z() < kNearPlane && to.z() > kNearPlane) {
        const float share = (kNearPlane - from.z()) / (to.z() - from.z());
        bounds.add(from + share * (to - from), camera);
      }
    }
  }
  return bounds;
}

}  // namespace

ScreenTiles::ScreenTiles(const std::vector<PlacedPrimitive>& placed, const Camera& camera)
    : placed_(placed), columns_((camera.width + kSide - 1) / kSide) {
  const int rows = (camera.height + kSide - 1) / kSide;
  tiles_.resize(static_cast<std::size_t>(columns_ * rows));
  const auto tile = [](float pixel, int count) {
    return static_cast<int>(std::floor(std::clamp(pixel / kSide, -1.0f, count + 0.0f)));
  };
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Bounds bounds = bounds_of(placed[i], camera);
    if (bounds.nearest == kNoHit) continue;
    const int last_column = std::min(tile(bounds.right + 1.0f, columns_), columns_ - 1);
    const int last_row = std::min(tile(bounds.bottom + 1.0f, rows), rows - 1);
    for (int row = std::max(tile(bounds.top - 1.0f, rows), 0); row <= last_row; ++row) {
      for (int c = std::max(tile(bounds.left - 1.0f, columns_), 0); c <= last_column; ++c) {
        tiles_[static_cast<std::size_t>(row * columns_ + c)].push_back(
            {static_cast<int>(i), bounds.nearest});
      }
    }
  }
  for (auto& candidates : tiles_) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.nearest < b.nearest; });
  }
}

std::pair<int, float> ScreenTiles::first_hit(int u, int v, const Eigen::Vector3f& ray) const {
  int first = -1;
  float z = kNoHit;
  for (const auto& candidate : tiles_[static_cast<std::size_t>(v / kSide * columns_ + u / kSide)]) {
    if (candidate.nearest > z) break;
    const float hit = intersect(placed_[static_cast<std::size_t>(candidate.index)], ray);
    if (hit < z) {
      z = hit;
      first = candidate.index;
    }
  }
  return {first, z};
}

}  // namespace rprr
