// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_wire/bytes.hpp"

namespace rprr {

/// A preview's colours (CV_8UC3) as a lossy WebP image less 27 bytes: the container, and what the
/// frame header says that a preview says anyway. quality: WebP's, 0 to 100. Empty if libwebp fails.
Bytes encode_preview_colour(const cv::Mat& bgr, int quality);

/// Into an image of the right size. False for anything malformed.
bool decode_preview_colour(ByteView bytes, cv::Mat& bgr);

}  // namespace rprr
