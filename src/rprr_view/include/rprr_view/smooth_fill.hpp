// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace rprr {

/// Spreads known colours smoothly over unknown pixels (push-pull over a pyramid: Gortler et al.,
/// The Lumigraph, 1996). Linear in the number of pixels. Keeps its buffers between frames; one
/// object serves one thread.
class SmoothFiller {
 public:
  /// bgr: CV_8UC3, filled in place where known (CV_8UC1, same size) is 0. Known pixels are not
  /// touched. Without any known pixel all become mid-grey.
  void fill(cv::Mat& bgr, const cv::Mat& known);

 private:
  std::vector<cv::Mat> levels_;  // CV_32FC4 from half size on: colour times weight, weight
};

}  // namespace rprr
