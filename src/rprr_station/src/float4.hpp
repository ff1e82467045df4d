// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
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
  return Float4{static_cast<float>(from[0]), static_cast<float>(from[1]),
                static_cast<float>(from[2]), 0.0f};
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

inline cv::Size half(cv::Size size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

/// Calls visit(u, v, four pixels' values) for the 2x2 cells of an image; at(u, v) gives a pixel.
template <typename At, typename Visit>
void for_cells(cv::Size fine, const At& at, const Visit& visit) {
  const cv::Size coarse = half(fine);
  for (int v = 0; v < coarse.height; ++v) {
    const int upper = 2 * v;
    const int lower = std::min(2 * v + 1, fine.height - 1);
    for (int u = 0; u < coarse.width; ++u) {
      const int left = 2 * u;
      const int right = std::min(2 * u + 1, fine.width - 1);
      visit(u, v, at(left, upper), at(right, upper), at(left, lower), at(right, lower));
    }
  }
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
