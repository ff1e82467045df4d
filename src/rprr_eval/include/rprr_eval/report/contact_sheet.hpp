// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace rprr {

/// A picture with its caption.
struct Captioned {
  std::string caption;
  cv::Mat bgr;  // CV_8UC3; an empty one leaves its place grey
};

/// The pictures side by side, two in a row, each scaled to the given width, captions above.
/// CV_8UC3.
cv::Mat contact_sheet(const std::vector<Captioned>& pictures, int width);

}  // namespace rprr
