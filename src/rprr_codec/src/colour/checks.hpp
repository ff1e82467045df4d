// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "rprr_codec/colour_codec.hpp"

namespace rprr {

/// Empty, or why a codec does not encode this image at this quality.
std::string unencodable(const cv::Mat& bgr, int quality, const ColourCodecInfo& info);

/// The size if it is one that RPRR accepts, else an error.
Result<cv::Size> possible_size(int width, int height);

}  // namespace rprr
