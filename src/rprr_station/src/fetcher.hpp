// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/core/mat.hpp>

#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// Fetches colours of the reference image for points of the target view, bilinearly.
class Fetcher {
 public:
  /// bgr: CV_8UC3, continuous, of the depth's size.
  Fetcher(const DepthFrame& depth, const cv::Mat& bgr, float tolerance)
      : depth_(depth.counts.ptr<std::uint16_t>()),
        bgr_(bgr.ptr<std::uint8_t>()),
        cols_(bgr.cols),
        rows_(bgr.rows),
        unit_(static_cast<float>(depth.unit)),
        tolerance_(tolerance),
        right_(static_cast<float>(bgr.cols - 1)),
        bottom_(static_cast<float>(bgr.rows - 1)) {}

  /// Colour at (x, y), if the reference shows the surface at depth z there, or has no depth there.
  bool fetch(float x, float y, float z, std::uint8_t* colour) const {
    if (!(x >= -0.5f && y >= -0.5f && x < right_ + 0.5f && y < bottom_ + 0.5f)) return false;
    x = std::clamp(x, 0.0f, right_);
    y = std::clamp(y, 0.0f, bottom_);
    const int nearest = static_cast<int>(y + 0.5f) * cols_ + static_cast<int>(x + 0.5f);
    const float seen = unit_ * static_cast<float>(depth_[nearest]);
    if (seen > 0.0f && std::abs(seen - z) > tolerance_ * z) return false;
    interpolate(x, y, colour);
    return true;
  }

  /// The colour of a pixel, by its index.
  const std::uint8_t* pixel(int index) const {
    return bgr_ + 3 * static_cast<std::ptrdiff_t>(index);
  }

 private:
  // 7 bits each way: what 8-bit colours deserve.
  void interpolate(float x, float y, std::uint8_t* colour) const {
    const int u = std::min(static_cast<int>(x), std::max(cols_ - 2, 0));
    const int v = std::min(static_cast<int>(y), std::max(rows_ - 2, 0));
    const int across = static_cast<int>((x - static_cast<float>(u)) * 128.0f + 0.5f);
    const int down = static_cast<int>((y - static_cast<float>(v)) * 128.0f + 0.5f);
    const std::uint8_t* upper = pixel(v * cols_ + u);
    // Eight bytes are read of each row, two more than the two pixels have.
    const bool inside = v + 2 < rows_ && cols_ > 2;
    if (!inside) return interpolate_at_rim(u, v, across, down, colour);
    std::int16_t mixed[8];
    store(mix(load(upper), load(upper + 3 * cols_), down), mixed);
    for (int i = 0; i < 3; ++i) {
      colour[i] = static_cast<std::uint8_t>(
          (128 * mixed[i] + across * (mixed[i + 3] - mixed[i]) + 64) >> 7);
    }
  }

  void interpolate_at_rim(int u, int v, int across, int down, std::uint8_t* colour) const {
    const int next = std::min(u + 1, cols_ - 1);
    const int below = std::min(v + 1, rows_ - 1);
    for (int i = 0; i < 3; ++i) {
      const auto at = [&](int row, int column) {
        return static_cast<int>(pixel(row * cols_ + column)[i]);
      };
      const int left = (at(v, u) * (128 - down) + at(below, u) * down + 64) >> 7;
      const int right = (at(v, next) * (128 - down) + at(below, next) * down + 64) >> 7;
      colour[i] = static_cast<std::uint8_t>((left * (128 - across) + right * across + 64) >> 7);
    }
  }

  // Eight 16-bit lanes in the compilers' portable vector type.
  using Lanes = std::int16_t __attribute__((vector_size(16)));
  using Octets = std::uint8_t __attribute__((vector_size(8)));
  static Lanes load(const std::uint8_t* from) {
    Octets bytes;
    std::memcpy(&bytes, from, sizeof(bytes));
    return __builtin_convertvector(bytes, Lanes);
  }
  static void store(Lanes lanes, std::int16_t* to) { std::memcpy(to, &lanes, sizeof(lanes)); }
  static Lanes all(int value) {
    const auto v = static_cast<std::int16_t>(value);
    return Lanes{v, v, v, v, v, v, v, v};
  }
  // Within 16 bits: what overflows on the way comes back, since the sum is at most 255 * 128 + 64.
  static Lanes mix(Lanes upper, Lanes lower, int down) {
    return ((upper << 7) + (lower - upper) * all(down) + all(64)) >> 7;
  }

  const std::uint16_t* depth_;
  const std::uint8_t* bgr_;
  int cols_;
  int rows_;
  float unit_;
  float tolerance_;
  float right_;
  float bottom_;
};

}  // namespace rprr
