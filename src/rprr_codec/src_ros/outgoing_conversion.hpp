// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/OutgoingFrame.h>

#include <opencv2/core/mat.hpp>

#include "rprr_codec/encoded_frame.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"

namespace rprr {

/// What FrameEncoder takes. The images share the message's pixels: keep the message alive.
struct OutgoingImages {
  DepthFrame depth;
  cv::Mat bgr;
  EncodedFrame frame;  // all but the payloads
};

/// Errors: a message whose parts do not make sense or do not fit together.
Result<OutgoingImages> images_of(const rprr_msgs::OutgoingFrame& message, double unit_for_float);

}  // namespace rprr
