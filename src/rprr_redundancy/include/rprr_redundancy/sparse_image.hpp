// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/result.hpp"

namespace rprr {

/// A picture for people of what is sent: the blocks of the mask as they are in the image, zero
/// (black; no reading in depth) elsewhere. Any type of image; the result is new memory of the same
/// type. Errors: an image that is not of the mask's size.
Result<cv::Mat> keep_blocks(const cv::Mat& image, const BlockMask& mask);

}  // namespace rprr
