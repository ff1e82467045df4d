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
  static constexpr int kBits = 7;  // of a pixel each way: what 8-bit colours deserve
  static constexpr int kOne = 1 << kBits;

  /// bgr: CV_8UC3, continuous, of the depth's size.
  Fetcher(const DepthFrame& depth, const cv::Mat& bgr, float tolerance)
      : depth_(depth.counts.ptr<std::uint16_t>()),
        bgr_(bgr.ptr<std::uint8_t>()),
        cols_(bgr.cols),
        rows_(bgr.rows),
        unit_(static_cast<float>(depth.unit)),
        tolerance_(tolerance) {}

  /// Places for fetch(): x and y in pixels, turned into steps of 1 / kOne and kept in the image; -1
  /// in x where they are more than half a pixel out of it. Plain numbers, so that compilers
  /// vectorise it.
  void find_places(const float* __restrict x, const float* __restrict y, int count,
                   int* __restrict x_steps, int* __restrict y_steps) const {
    const auto right = static_cast<float>(cols_ - 1);
    const auto bottom = static_cast<float>(rows_ - 1);
    for (int i = 0; i < count; ++i) {
      const int out = static_cast<int>(!(x[i] >= -0.5f)) | static_cast<int>(!(y[i] >= -0.5f)) |
                      static_cast<int>(!(x[i] < right + 0.5f)) |
                      static_cast<int>(!(y[i] < bottom + 0.5f));
      // In this order what is not a number becomes 0.
      const float u = std::min(std::max(0.0f, x[i]), right);
      const float v = std::min(std::max(0.0f, y[i]), bottom);
      x_steps[i] = static_cast<int>(u * kOne + 0.5f) | -out;
      y_steps[i] = static_cast<int>(v * kOne + 0.5f);
    }
  }

  /// Colour at a place, if the reference shows the surface at depth z there, or has no depth there.
  bool fetch(int x_steps, int y_steps, float z, std::uint8_t* colour) const {
    if (x_steps < 0) return false;
    constexpr int kHalf = kOne / 2;
    const int nearest = ((y_steps + kHalf) >> kBits) * cols_ + ((x_steps + kHalf) >> kBits);
    const float seen = unit_ * static_cast<float>(depth_[nearest]);
    if (seen > 0.0f && std::abs(seen - z) > tolerance_ * z) return false;
    interpolate(x_steps, y_steps, colour);
    return true;
  }

  /// The colour of a pixel, by its index.
  const std::uint8_t* pixel(int index) const {
    return bgr_ + 3 * static_cast<std::ptrdiff_t>(index);
  }

 private:
  void interpolate(int x, int y, std::uint8_t* colour) const {
    const int u = std::min(x >> kBits, cols_ - 2);
    const int v = std::min(y >> kBits, rows_ - 2);
    const int across = x - (u << kBits);
    const int down = y - (v << kBits);
    // Four bytes are read of each pixel, one more than it has.
    if (v + 2 >= rows_ || u < 0 || v < 0) return interpolate_at_rim(u, v, across, down, colour);
    const std::uint8_t* upper = pixel(v * cols_ + u);
    const std::uint8_t* lower = upper + 3 * cols_;
    const Lanes columns = mix(load(upper, lower), load(upper + 3, lower + 3), across);
    store(mix(columns, upper_half(columns), down), colour);
  }

  void interpolate_at_rim(int u, int v, int across, int down, std::uint8_t* colour) const {
    // Images of one row or column have no second.
    const int left = std::max(u, 0);
    const int top = std::max(v, 0);
    const int next = std::min(left + 1, cols_ - 1);
    const int below = std::min(top + 1, rows_ - 1);
    for (int i = 0; i < 3; ++i) {
      const auto row = [&](int line) {
        const int near = pixel(line * cols_ + left)[i];
        return near + ((across * (pixel(line * cols_ + next)[i] - near) + kOne / 2) >> kBits);
      };
      const int above = row(top);
      colour[i] =
          static_cast<std::uint8_t>(above + ((down * (row(below) - above) + kOne / 2) >> kBits));
    }
  }

  // Eight 16-bit lanes in the compilers' portable vector type: a pixel of an upper row in four,
  // one of the row below in the others.
  using Lanes = std::int16_t __attribute__((vector_size(16)));
  using Octets = std::uint8_t __attribute__((vector_size(8)));
  using Halves = std::int64_t __attribute__((vector_size(16)));

  static Lanes load(const std::uint8_t* upper, const std::uint8_t* lower) {
    Octets bytes;
    std::memcpy(&bytes, upper, 4);
    std::memcpy(reinterpret_cast<char*>(&bytes) + 4, lower, 4);
    return __builtin_convertvector(bytes, Lanes);
  }
  static Lanes upper_half(Lanes lanes) {
    const auto halves = reinterpret_cast<Halves>(lanes);
    return reinterpret_cast<Lanes>(Halves{halves[1], halves[1]});
  }
  static Lanes all(int value) {
    const auto v = static_cast<std::int16_t>(value);
    return Lanes{v, v, v, v, v, v, v, v};
  }
  // a + share (b - a), share in steps; products are at most 255 * 128 either way.
  static Lanes mix(Lanes a, Lanes b, int share) {
    return a + (((b - a) * all(share) + all(kOne / 2)) >> kBits);
  }
  static void store(Lanes lanes, std::uint8_t* colour) {
    const Octets bytes = __builtin_convertvector(lanes, Octets);
    std::memcpy(colour, &bytes, 3);
  }

  const std::uint16_t* depth_;
  const std::uint8_t* bgr_;
  int cols_;
  int rows_;
  float unit_;
  float tolerance_;
};

}  // namespace rprr
