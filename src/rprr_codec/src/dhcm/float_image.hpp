// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>

#include "dhcm/container.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {

/// Whole steps of a 32FC1 image in metres; what is not finite or not positive becomes 0. Error: a
/// reading that has no number of steps from 1 to 65535.
Result<DepthFrame> quantise(const cv::Mat& metres, double step);

using EncodePlane = std::function<Bytes(const DepthFrame&)>;
using DecodePlane = std::function<Result<DepthFrame>(ByteView)>;

/// The payload of a 32FC1 image, bit by bit: as one image of counts where every pixel is a count of
/// a usual unit, else as two of the upper and lower halves of the numbers.
Bytes pack_float(const cv::Mat& metres, DhcmMode mode, const EncodePlane& encode);
/// What pack_float wrote; the planes' decoder checks their size.
Result<cv::Mat> unpack_float(const Opened& opened, const DecodePlane& decode);

}  // namespace rprr::dhcm
