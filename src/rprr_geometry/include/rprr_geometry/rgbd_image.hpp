// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// Colour and depth of one moment, pixel by pixel the same rays.
struct RgbdImage {
  cv::Mat bgr;       // CV_8UC3
  DepthFrame depth;  // of the same size
};

}  // namespace rprr
