// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/core/mat.hpp>

namespace rprr {

/// Four floats in the compilers' portable vector type: three colours and one number that goes with
/// them. Images of them are CV_32FC4.
using Float4 = float __attribute__((vector_size(16)));

inline const Float4* row4(const cv::Mat& image, int v) {
  return reinterpret_cast<const Float4*>(image.ptr(v));
}
inline Float4* row4(cv::Mat& image, int v) {
  return reinterpret_cast<Float4*>(image.ptr(v));
}

inline Float4 all4(float x) {
  return Float4{x, x, x, x};
}
inline Float4 load_bgr(const std::uint8_t* from) {
  using Int4 = int __attribute__((vector_size(16)));
  return __builtin_convertvector((Int4{from[0], from[1], from[2], 0}), Float4);
}
/// Rounded and clamped to what a byte holds.
inline void store_bgr(Float4 x, std::uint8_t* to) {
  using Int4 = int __attribute__((vector_size(16)));
  x += all4(0.5f);
  x = x < all4(0.0f) ? all4(0.0f) : x;
  x = x > all4(255.0f) ? all4(255.0f) : x;
  const Int4 rounded = __builtin_convertvector(x, Int4);
  to[0] = static_cast<std::uint8_t>(rounded[0]);
  to[1] = static_cast<std::uint8_t>(rounded[1]);
  to[2] = static_cast<std::uint8_t>(rounded[2]);
}

/// Rows of pixels of three colours as floats, and back as store_bgr does it (of less than 2^31),
/// so that each pixel is then a single load or store. Beyond the last pixel there is room for one
/// more float, which Float4 of that pixel takes in.
inline void to_floats(const std::uint8_t* __restrict from, int count, float* __restrict to) {
  for (int i = 0; i < count; ++i) to[i] = static_cast<float>(from[i]);
  to[count] = 0.0f;
}
inline void to_bytes(const float* from, int count, std::uint8_t* to) {
  int i = 0;
  // Packing saturates, which compilers do not find by themselves.
  const cv::v_float32x4 half = cv::v_setall_f32(0.5f);
  const auto four = [&](int k) { return cv::v_trunc(cv::v_load(from + i + 4 * k) + half); };
  for (; i + 16 <= count; i += 16) {
    cv::v_store(to + i, cv::v_pack_u(cv::v_pack(four(0), four(1)), cv::v_pack(four(2), four(3))));
  }
  for (; i < count; ++i) {
    const float x = std::min(std::max(from[i] + 0.5f, 0.0f), 255.0f);
    to[i] = static_cast<std::uint8_t>(static_cast<int>(x));
  }
}
/// The fourth number is the next pixel's first.
inline Float4 load_pixel(const float* row, int u) {
  Float4 pixel;
  std::memcpy(&pixel, row + 3 * u, sizeof pixel);
  return pixel;
}
/// From left to right: what it writes of the next pixel is not that pixel's.
inline void store_pixel(Float4 pixel, float* row, int u) {
  std::memcpy(row + 3 * u, &pixel, sizeof pixel);
}

inline cv::Size half(cv::Size size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

/// Calls visit(v, upper, lower) for the pairs of rows of an image.
template <typename Visit>
void for_row_pairs(int rows, const Visit& visit) {
  for (int v = 0; 2 * v < rows; ++v) visit(v, 2 * v, std::min(2 * v + 1, rows - 1));
}

/// Calls visit(u, four pixels' values) for the 2x2 cells of a pair of rows; at(u, 0) gives a pixel
/// of the upper row, at(u, 1) of the lower one.
template <typename At, typename Visit>
void for_cells_of_row(int columns, const At& at, const Visit& visit) {
  const int whole = columns / 2;
  for (int u = 0; u < whole; ++u) {
    visit(u, at(2 * u, 0), at(2 * u + 1, 0), at(2 * u, 1), at(2 * u + 1, 1));
  }
  if (columns % 2 != 0) {
    const int last = columns - 1;
    visit(whole, at(last, 0), at(last, 0), at(last, 1), at(last, 1));
  }
}

/// Calls visit(u, v, four pixels' values) for the 2x2 cells of an image; at(u, v) gives a pixel.
template <typename At, typename Visit>
void for_cells(cv::Size fine, const At& at, const Visit& visit) {
  for_row_pairs(fine.height, [&](int v, int upper, int lower) {
    for_cells_of_row(
        fine.width, [&](int u, int i) { return at(u, i == 0 ? upper : lower); },
        [&](int u, const auto& a, const auto& b, const auto& c, const auto& d) {
          visit(u, v, a, b, c, d);
        });
  });
}

/// Calls visit(column, value) for a row of the image of twice the size of `coarse`, whose pixels
/// lie a quarter and three quarters of the way between its own. `coarse` has (rows + 1) / 2 rows
/// and (columns + 1) / 2 columns. mixed: room for coarse.cols + 2.
template <typename Visit>
void for_enlarged_row(const cv::Mat& coarse, int fine_row, int fine_columns, Float4* mixed,
                      const Visit& visit) {
  const int near = fine_row / 2;
  const int far = std::clamp(near + (fine_row % 2 == 0 ? -1 : 1), 0, coarse.rows - 1);
  const Float4* a = row4(coarse, near);
  const Float4* b = row4(coarse, far);
  Float4* const m = mixed + 1;
  for (int u = 0; u < coarse.cols; ++u) m[u] = all4(0.75f) * a[u] + all4(0.25f) * b[u];
  m[-1] = m[0];
  m[coarse.cols] = m[coarse.cols - 1];
  const int pairs = fine_columns / 2;
  for (int u = 0; u < pairs; ++u) {
    const Float4 here = all4(0.75f) * m[u];
    visit(2 * u, here + all4(0.25f) * m[u - 1]);
    visit(2 * u + 1, here + all4(0.25f) * m[u + 1]);
  }
  if (fine_columns % 2 != 0) {
    visit(2 * pairs, all4(0.75f) * m[pairs] + all4(0.25f) * m[pairs - 1]);
  }
}

}  // namespace rprr
