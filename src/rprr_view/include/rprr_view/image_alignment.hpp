// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace rprr {

/// By how much a prediction is shifted against what the dependent saw, place by place: what is left
/// of the pose's error, the sensors' own registration and their shutters. Lucas and Kanade's least
/// squares in large windows that overlap, with shifts of a pixel as the prior and doubtful
/// differences (occlusion, gloss) weighed down; offsets of brightness do not count.
///
/// Keeps its buffers between frames; one object serves one thread.
class ImageAlignment {
 public:
  static constexpr int kCell = 8;  // pixels of the images for one shift

  /// All of one size: prediction, base: CV_32FC1, brightness in grey levels; valid: CV_8UC1, 0
  /// where nothing is predicted. The result is CV_32FC2, one shift (x, y) for each cell of kCell x
  /// kCell pixels, in pixels of these images: base(p) is like prediction(p + shift). It stays valid
  /// until the next call.
  const cv::Mat& align(const cv::Mat& prediction, const cv::Mat& valid, const cv::Mat& base);

 private:
  enum Sum { kXX, kXY, kYY, kXE, kYE, kEE, kWeight, kSums };

  void shift_prediction(const cv::Mat& prediction, const cv::Mat& valid, const cv::Mat& base);
  void remove_offsets();
  void sum_up();
  void solve();

  cv::Mat shifts_;
  cv::Mat shifted_;     // CV_32FC1
  cv::Mat difference_;  // CV_32FC1, base minus shifted
  cv::Mat known_;       // CV_32FC1, 1 or 0
  cv::Mat offsets_, counts_, scratch_;
  std::array<cv::Mat, kSums> sums_;  // CV_32FC1, a number for each cell
};

/// Bilinear sample of shifts for each pixel of a row of an image that has `scale` times the pixels
/// of the images aligned a side, in its pixels: x and y take its width.
void shifts_of_row(const cv::Mat& shifts, int scale, int row, int width, float* x, float* y);

}  // namespace rprr
