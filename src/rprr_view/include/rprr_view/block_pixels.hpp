// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <opencv2/core/mat.hpp>

namespace rprr {

// For rectangles of a few pixels, where calls of cv::Mat's functions cost more than the pixels.

/// Sets the pixels of a CV_8UC1 image.
inline void set_pixels(cv::Mat& image, const cv::Rect& rect, std::uint8_t value) {
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    std::memset(image.ptr(v, rect.x), value, static_cast<std::size_t>(rect.width));
  }
}

/// Copies pixels from an image of the same size and type.
inline void copy_pixels(const cv::Mat& from, const cv::Rect& rect, cv::Mat& to) {
  const std::size_t bytes = from.elemSize() * static_cast<std::size_t>(rect.width);
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    std::memcpy(to.ptr(v, rect.x), from.ptr(v, rect.x), bytes);
  }
}

/// Whether any pixel of a CV_16UC1 image is not 0.
inline bool any_pixel(const cv::Mat& image, const cv::Rect& rect) {
  unsigned any = 0;
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    const auto* from = image.ptr<std::uint16_t>(v) + rect.x;
    for (int u = 0; u < rect.width; ++u) any |= from[u];
  }
  return any != 0;
}

}  // namespace rprr
