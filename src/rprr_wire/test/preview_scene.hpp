// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// A slanted plane with a nearer box on it and a hole; smooth colours.
struct PreviewScene {
  DepthFrame depth;
  cv::Mat bgr;
  explicit PreviewScene(int width = 640, int height = 480)
      : depth{cv::Mat(height, width, CV_16UC1), 0.001}, bgr(height, width, CV_8UC3) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double q = 0.3 + 0.0002 * u + 0.0003 * v;
        depth.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(1000.0 / q));
        bgr.at<cv::Vec3b>(v, u) = cv::Vec3b(
            static_cast<std::uint8_t>(u * 255 / width), static_cast<std::uint8_t>(v * 255 / height),
            static_cast<std::uint8_t>(128 + 60 * std::sin(0.02 * (u + v))));
      }
    }
    const cv::Rect image(0, 0, width, height);
    depth.counts(cv::Rect(203, 100, 100, 120) & image).setTo(900);
    depth.counts(cv::Rect(400, 300, 64, 64) & image).setTo(0);
  }
  /// As a Kinect sees it: depth only at whole steps of inverse depth, so few distinct counts.
  PreviewScene& quantise() {
    for (auto it = depth.counts.begin<std::uint16_t>(); it != depth.counts.end<std::uint16_t>();
         ++it) {
      if (*it == 0) continue;
      const double disparity = std::round(1000.0 / *it / 0.00285);
      *it = static_cast<std::uint16_t>(std::lround(1000.0 / (disparity * 0.00285)));
    }
    return *this;
  }
};

}  // namespace rprr
