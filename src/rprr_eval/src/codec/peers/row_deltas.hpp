// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_wire/bytes.hpp"

namespace rprr {

/// What general-purpose compressors are given: the difference of each pixel to its left neighbour
/// (a row's first one to 0), modulo 2^16 and folded so that small ones of either sign are small
/// numbers; all low bytes first, then all high bytes.
void split_row_deltas(const cv::Mat& counts, Bytes& planes);
/// The inverse, into an image of the right size.
void join_row_deltas(const Bytes& planes, cv::Mat& counts);

}  // namespace rprr
