// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/core/mat.hpp>

#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/pixel_map.hpp"

namespace rprr {

/// Where points lie in the reference image, each in arrays of the caller's.
struct FetchPlaces {
  int* nearest;  // index of the nearest pixel; -1: more than half a pixel out of the image
  int* column;   // of the upper left one of the four pixels around
  int* row;
  int* across;  // from there, in steps of 1 / Fetcher::kOne
  int* down;
};

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
        tolerance_(tolerance),
        row_bytes_(3 * bgr.cols),
        // Images of a single column or row are all rim.
        last_row_(bgr.cols < 2 || bgr.rows < 2 ? -1 : bgr.rows - 2) {}

  /// Where points x, y (pixels) lie. Plain numbers, so that compilers vectorise it.
  void find_places(const float* __restrict x, const float* __restrict y, int count,
                   const FetchPlaces& places) const {
    int* __restrict const nearest = places.nearest;
    int* __restrict const column = places.column;
    int* __restrict const row = places.row;
    int* __restrict const across = places.across;
    int* __restrict const down = places.down;
    const auto right = static_cast<float>(cols_ - 1);
    const auto bottom = static_cast<float>(rows_ - 1);
    const int cols = cols_, last_column = cols_ - 2, last_row = rows_ - 2;
    constexpr int kHalf = kOne / 2;
    for (int i = 0; i < count; ++i) {
      const int out = static_cast<int>(!(x[i] >= -0.5f)) | static_cast<int>(!(y[i] >= -0.5f)) |
                      static_cast<int>(!(x[i] < right + 0.5f)) |
                      static_cast<int>(!(y[i] < bottom + 0.5f));
      // In this order what is not a number becomes 0.
      const float u = std::min(std::max(0.0f, x[i]), right);
      const float v = std::min(std::max(0.0f, y[i]), bottom);
      const int x_steps = static_cast<int>(u * kOne + 0.5f);
      const int y_steps = static_cast<int>(v * kOne + 0.5f);
      nearest[i] = (((y_steps + kHalf) >> kBits) * cols + ((x_steps + kHalf) >> kBits)) | -out;
      column[i] = std::min(x_steps >> kBits, last_column);
      row[i] = std::min(y_steps >> kBits, last_row);
      across[i] = x_steps - column[i] * kOne;
      down[i] = y_steps - row[i] * kOne;
    }
  }

  /// Depths that the reference has nearest to places, metres; 0 where it has none.
  void look(const int* __restrict nearest, int count, float* __restrict seen) const {
    for (int i = 0; i < count; ++i) {
      seen[i] = unit_ * static_cast<float>(depth_[std::max(nearest[i], 0)]);
    }
  }

  /// Flags the places where the reference shows the surface at depth z, or has no depth.
  void compare(const int* __restrict nearest, const float* __restrict seen,
               const float* __restrict z, int count, std::uint8_t* __restrict shows) const {
    const float tolerance = tolerance_;
    for (int i = 0; i < count; ++i) {
      const int other = static_cast<int>(seen[i] > 0.0f) &
                        static_cast<int>(std::abs(seen[i] - z[i]) > tolerance * z[i]);
      shows[i] = static_cast<std::uint8_t>(static_cast<int>(z[i] >= kNearestDepth) &
                                           static_cast<int>(nearest[i] >= 0) & (other ^ 1));
    }
  }

  /// Colour at the i-th place, which is in the image.
  void fetch(const FetchPlaces& places, int i, std::uint8_t* colour) const {
    const int u = places.column[i];
    const int v = places.row[i];
    const int across = places.across[i];
    const int down = places.down[i];
    // Eight bytes are read of each row, two more than its two pixels have.
    if (v >= last_row_) return interpolate_at_rim(u, v, across, down, colour);
    const std::uint8_t* corner = pixel(v * cols_ + u);
    const Lanes upper = load(corner);
    const Lanes lower = load(corner + row_bytes_);
    const Lanes columns =
        mix(cv::v_combine_low(upper, lower),
            cv::v_combine_low(cv::v_rotate_right<3>(upper), cv::v_rotate_right<3>(lower)), across);
    store(mix(columns, cv::v_combine_high(columns, columns), down), colour);
  }

  /// The colour of a pixel, by its index.
  const std::uint8_t* pixel(int index) const {
    return bgr_ + 3 * static_cast<std::ptrdiff_t>(index);
  }

 private:
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

  // Eight numbers of 16 bits: of two pixels that follow each other, or a pixel of an upper row in
  // four and one of the row below in the others.
  using Lanes = cv::v_int16x8;

  static Lanes load(const std::uint8_t* from) {
    return cv::v_reinterpret_as_s16(cv::v_load_expand(from));
  }
  // a + share (b - a), share in steps; products are at most 255 * 128 either way.
  static Lanes mix(const Lanes& a, const Lanes& b, int share) {
    const Lanes part = cv::v_mul_wrap(b - a, cv::v_setall_s16(static_cast<short>(share)));
    return a + cv::v_shr<kBits>(part + cv::v_setall_s16(kOne / 2));
  }
  static void store(const Lanes& lanes, std::uint8_t* colour) {
    const unsigned bytes = cv::v_reinterpret_as_u32(cv::v_pack_u(lanes, lanes)).get0();
    std::memcpy(colour, &bytes, 3);
  }

  const std::uint16_t* depth_;
  const std::uint8_t* bgr_;
  int cols_;
  int rows_;
  float unit_;
  float tolerance_;
  int row_bytes_;
  int last_row_;
};

}  // namespace rprr
