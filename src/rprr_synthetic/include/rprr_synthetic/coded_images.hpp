// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <random>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/depth_frame.hpp"

namespace rprr::synthetic {

/// Depth as a Kinect sees slanted planes: disparity levels, a step, shadows and specks of no
/// reading. Integers only, so that it is the same on every machine.
inline DepthFrame kinect_like(int width, int height, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  DepthFrame frame;
  frame.counts.create(height, width, CV_16UC1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const bool near = u > width / 3 && u < width / 2 && v > height / 4;
      const int wiggle = random() % 16 == 0 ? 1 : 0;
      const int disparity = near ? 700 : 300 + u / 3 + v / 5 + wiggle;
      const bool shadow = u >= width / 2 && u < width / 2 + width / 20 && v > height / 4;
      const bool speck = random() % 97 == 0;
      frame.counts.at<std::uint16_t>(v, u) =
          static_cast<std::uint16_t>(shadow || speck ? 0 : 580000 / disparity);
    }
  }
  return frame;
}

inline DepthFrame noise(int width, int height, std::uint32_t seed = 2) {
  std::mt19937 random(seed);
  DepthFrame frame;
  frame.counts.create(height, width, CV_16UC1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      frame.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(random());
    }
  }
  return frame;
}

inline DepthFrame constant(int width, int height, std::uint16_t value) {
  return {cv::Mat(height, width, CV_16UC1, cv::Scalar(value)), 0.001};
}

/// Smooth colours with some texture.
inline cv::Mat colourful(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const bool stripe = (u / 16 + v / 24) % 2 == 0;
      image.at<cv::Vec3b>(v, u) = cv::Vec3b(static_cast<std::uint8_t>(40 + u % 160),
                                            static_cast<std::uint8_t>(60 + v % 128),
                                            static_cast<std::uint8_t>(stripe ? 180 : 90));
    }
  }
  return image;
}

inline BlockMask some_blocks(const BlockGrid& grid, double share, std::uint32_t seed = 3) {
  std::mt19937 random(seed);
  BlockMask mask(grid);
  for (int block = 0; block < grid.count(); ++block) {
    mask.set(block, random() % 1000 < share * 1000);
  }
  return mask;
}

/// A connected region of about the share of blocks stated.
inline BlockMask region(const BlockGrid& grid, double share) {
  BlockMask mask(grid);
  for (int block = 0; block < grid.count(); ++block) {
    mask.set(block, block % grid.columns < grid.columns * share);
  }
  return mask;
}

inline bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

/// The image with what is outside the mask set to 0.
inline cv::Mat only(const cv::Mat& image, const BlockMask& mask) {
  cv::Mat out = cv::Mat::zeros(image.size(), image.type());
  image.copyTo(out, mask.to_image());
  return out;
}

}  // namespace rprr::synthetic
