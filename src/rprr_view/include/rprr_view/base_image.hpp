// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace rprr {

/// The dependent's whole colour frame at low quality, as received: the layer under the prediction.
struct BaseImage {
  /// CV_8UC3; each pixel stands for the mean of a cell of reduction x reduction pixels of the frame
  /// (cells at the right and lower rim may be cut). Empty: there is no base.
  cv::Mat bgr;
  int reduction = 1;   // 1, 2, 4, 8 or 16
  float noise = 8.0f;  // RMS of its coding error, as its sender states it [grey levels]

  bool empty() const { return bgr.empty(); }
  /// Whether it is a base of a frame of this size.
  bool fits(cv::Size frame) const {
    const bool known =
        reduction == 1 || reduction == 2 || reduction == 4 || reduction == 8 || reduction == 16;
    return known && bgr.type() == CV_8UC3 && noise > 0.0f && noise < 256.0f &&
           bgr.cols == (frame.width + reduction - 1) / reduction &&
           bgr.rows == (frame.height + reduction - 1) / reduction;
  }
};

}  // namespace rprr
