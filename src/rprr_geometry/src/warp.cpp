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

  // All pixels from left to right and top to bottom, as far as they are in the image.
  void cover(int left, int top, int right, int bottom, float depth, int source) const {
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

// Numbers of a stretch of a row.
template <typename T>
using Stretch = std::array<T, kStretch>;

// Pixels that a stretch of a row covers, by their first and last columns and rows. Those of what is
// not seen are empty: right is less than left.
struct Covered {
  Stretch<int> left, top, right, bottom;
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

// Pixels whose centres are within half a footprint of (x, y), which is in the image: x and y as
// project() gives them. half_at_unit: half a footprint where source and target see a depth of one
// count alike. They are plain numbers, which stay in registers.
template <Footprint kFootprint>
void find_covered(const std::uint16_t* __restrict counts, const float* __restrict x,
                  const float* __restrict y, const float* __restrict depth, int count, float width,
                  float height, float half_at_unit, Covered& covered) {
  int* __restrict const left = covered.left.data();
  int* __restrict const top = covered.top.data();
  int* __restrict const right = covered.right.data();
  int* __restrict const bottom = covered.bottom.data();
  for (int i = 0; i < count; ++i) {
    const int seen = static_cast<int>(counts[i] != 0) &
                     static_cast<int>(depth[i] >= kNearestDepth) & static_cast<int>(x[i] >= 0.0f) &
                     static_cast<int>(y[i] >= 0.0f) & static_cast<int>(x[i] < width) &
                     static_cast<int>(y[i] < height);
    // Changes only what is not seen: in this order what is not a number becomes 0.
    const float u = std::min(std::max(0.0f, x[i]), width);
    const float v = std::min(std::max(0.0f, y[i]), height);
    if constexpr (kFootprint == Footprint::kNearest) {
      left[i] = static_cast<int>(u);
      top[i] = static_cast<int>(v);
      right[i] = left[i] | (seen - 1);
      bottom[i] = top[i];
    } else {
      const float wanted = half_at_unit * static_cast<float>(counts[i]) / depth[i];
      const float half = std::min(std::max(0.5f * kOverlap, wanted), 0.5f * kLargestFootprint);
      left[i] = static_cast<int>(u - 0.5f - half + 1.0f);
      top[i] = static_cast<int>(v - 0.5f - half + 1.0f);
      right[i] = static_cast<int>(u - 0.5f + half) | (seen - 1);
      bottom[i] = static_cast<int>(v - 0.5f + half);
    }
  }
}

template <Footprint kFootprint>
void warp(const DepthFrame& source, const Camera& from, const Camera& to,
          const Pose& target_from_source, WarpedDepth& out) {
  const PixelMap to_target(from, to, target_from_source, source.unit);
  const auto width = static_cast<float>(to.width);
  const auto height = static_cast<float>(to.height);
  const auto half_at_equal_depth =
      static_cast<float>(0.5 * kOverlap * source.unit * std::max(to.fx / from.fx, to.fy / from.fy));
  const Target target(out, to.width, to.height);
  Stretch<float> x, y, depth;
  Covered covered;

  for (int v = 0; v < source.height(); ++v) {
    const auto* counts = source.counts.ptr<std::uint16_t>(v);
    for (int begin = 0; begin < source.width(); begin += kStretch) {
      const int count = std::min(kStretch, source.width() - begin);
      project(to_target, counts + begin, begin, v, count, x.data(), y.data(), depth.data());
      find_covered<kFootprint>(counts + begin, x.data(), y.data(), depth.data(), count, width,
                               height, half_at_equal_depth, covered);
      const int index = v * source.width() + begin;
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const int left = covered.left[at], right = covered.right[at];
        const int top = covered.top[at], bottom = covered.bottom[at];
        if (left == right && top == bottom) {
          target.put(left, top, depth[at], index + i);
        } else if (right >= 0) {
          target.cover(left, top, right, bottom, depth[at], index + i);
        }
      }
    }
  }
}

}  // namespace

void warp_depth(const DepthFrame& source, const Camera& source_camera, const Camera& target_camera,
                const Pose& target_from_source, WarpedDepth& out, Footprint footprint) {
  out.metres.create(target_camera.height, target_camera.width, CV_32FC1);
  out.source.create(target_camera.height, target_camera.width, CV_32SC1);
  out.metres.setTo(0);
  out.source.setTo(-1);
  const auto run =
      footprint == Footprint::kNearest ? warp<Footprint::kNearest> : warp<Footprint::kSurface>;
  run(source, source_camera, target_camera, target_from_source, out);
}

}  // namespace rprr
