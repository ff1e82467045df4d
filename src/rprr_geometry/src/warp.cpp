// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/warp.hpp"

#include <algorithm>
#include <array>

#include "rprr_geometry/pixel_map.hpp"

namespace rprr {
namespace {

constexpr float kLargestFootprint = 2.5f;  // pixels a side; what is stretched more stays open
constexpr int kStretch = 256;              // pixels whose coordinates are computed together
constexpr float kOverlap = 1.04f;          // of footprints, so that rounding opens no cracks

// Writes depths with their sources, the nearest to the camera last to go.
class Target {
 public:
  Target(WarpedDepth& out, int width, int height)
      : depth_(out.metres.ptr<float>()),
        source_(out.source.ptr<int>()),
        width_(width),
        height_(height) {}

  void put(int u, int v, float depth, int source) const {
    const int at = v * width_ + u;
    if (depth_[at] == 0.0f || depth < depth_[at]) {
      depth_[at] = depth;
      source_[at] = source;
    }
  }

  // All pixels whose centre is within `half` of (x, y), which is in the image.
  void cover(float x, float y, float half, float depth, int source) const {
    const int left = static_cast<int>(x - half + 1.0f);
    const int top = static_cast<int>(y - half + 1.0f);
    int right = static_cast<int>(x + half);
    int bottom = static_cast<int>(y + half);
    if (left == right && top == bottom) return put(left, top, depth, source);
    right = std::min(right, width_ - 1);
    bottom = std::min(bottom, height_ - 1);
    for (int v = std::max(top, 0); v <= bottom; ++v) {
      for (int u = std::max(left, 0); u <= right; ++u) put(u, v, depth, source);
    }
  }

 private:
  float* depth_;
  int* source_;
  int width_;
  int height_;
};

// Pixels (plus a half, to be cut off) and depths in the target of a stretch of a row. Plain
// numbers, so that compilers vectorise it.
void project(const PixelMap& to_target, const std::uint16_t* counts, int first, int v, int count,
             float* __restrict x, float* __restrict y, float* __restrict depth) {
  const Eigen::Vector3f start = to_target.row(v);
  const float sx = start.x(), sy = start.y(), sz = start.z();
  const float dx = to_target.step.x(), dy = to_target.step.y(), dz = to_target.step.z();
  const float tx = to_target.offset.x(), ty = to_target.offset.y(), tz = to_target.offset.z();
  for (int i = 0; i < count; ++i) {
    const auto z = static_cast<float>(counts[i]);
    const auto column = static_cast<float>(first + i);
    const float w = z * (sz + column * dz) + tz;
    const float inverse = 1.0f / w;
    x[i] = (z * (sx + column * dx) + tx) * inverse + 0.5f;
    y[i] = (z * (sy + column * dy) + ty) * inverse + 0.5f;
    depth[i] = w;
  }
}

template <Footprint kFootprint>
void warp(const DepthFrame& source, const Camera& from, const Camera& to, const Pose& motion,
          WarpedDepth& out) {
  const PixelMap to_target(from, to, motion, source.unit);
  const auto width = static_cast<float>(to.width);
  const auto height = static_cast<float>(to.height);
  const auto half_at_equal_depth =
      static_cast<float>(0.5 * kOverlap * source.unit * std::max(to.fx / from.fx, to.fy / from.fy));
  const Target target(out, to.width, to.height);
  std::array<float, kStretch> x, y, depth;

  for (int v = 0; v < source.height(); ++v) {
    const auto* counts = source.counts.ptr<std::uint16_t>(v);
    for (int begin = 0; begin < source.width(); begin += kStretch) {
      const int count = std::min(kStretch, source.width() - begin);
      project(to_target, counts + begin, begin, v, count, x.data(), y.data(), depth.data());
      const int index = v * source.width() + begin;
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (counts[begin + i] == 0 || !(depth[at] >= kNearestDepth)) continue;
        if (!(x[at] >= 0.0f && y[at] >= 0.0f && x[at] < width && y[at] < height)) continue;
        if constexpr (kFootprint == Footprint::kNearest) {
          target.put(static_cast<int>(x[at]), static_cast<int>(y[at]), depth[at], index + i);
        } else {
          const float half = half_at_equal_depth * static_cast<float>(counts[begin + i]);
          target.cover(x[at] - 0.5f, y[at] - 0.5f,
                       std::clamp(half / depth[at], 0.5f * kOverlap, 0.5f * kLargestFootprint),
                       depth[at], index + i);
        }
      }
    }
  }
}

}  // namespace

void warp_depth(const DepthFrame& source, const Camera& source_camera, const Camera& target_camera,
                const Pose& motion, WarpedDepth& out, Footprint footprint) {
  out.metres.create(target_camera.height, target_camera.width, CV_32FC1);
  out.source.create(target_camera.height, target_camera.width, CV_32SC1);
  out.metres.setTo(0);
  out.source.setTo(-1);
  const auto run =
      footprint == Footprint::kNearest ? warp<Footprint::kNearest> : warp<Footprint::kSurface>;
  run(source, source_camera, target_camera, motion, out);
}

}  // namespace rprr
