// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Lossless coding of a preview's depths (CV_16UC1, 0 = no reading), as doc/preview.md describes.
/// ranks: code each depth by its rank among those that occur, with a table of them ahead.
Bytes encode_preview_depth(const cv::Mat& depth, bool ranks);

/// Into an image of the right size. False for anything that encode_preview_depth does not write.
bool decode_preview_depth(ByteView bytes, bool ranks, cv::Mat& depth);

/// Whether a table pays: a Kinect's readings take few distinct values.
bool ranks_pay(const cv::Mat& depth);

}  // namespace rprr
