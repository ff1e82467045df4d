// SPDX-License-Identifier: BSD-3-Clause
#include "colour/checks.hpp"

#include <opencv2/core.hpp>

#include "rprr_geometry/camera.hpp"

namespace rprr {

std::string unencodable(const cv::Mat& bgr, int quality, const ColourCodecInfo& info) {
  if (bgr.empty() || bgr.type() != CV_8UC3) return "colour image is not 8-bit BGR";
  if (bgr.cols > kMaxImageSide || bgr.rows > kMaxImageSide) return "colour image too large";
  if (info.has_quality(quality)) return {};
  return "quality of " + info.name + " is " + std::to_string(quality) + ", must be " +
         std::to_string(info.best) + " (best) to " + std::to_string(info.coarsest) + " (coarsest)";
}

Result<cv::Size> possible_size(int width, int height) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
    return Error{"colour payload states an impossible image size"};
  }
  return cv::Size(width, height);
}

}  // namespace rprr
