// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/RgbdFrame.h>

#include "rprr_geometry/result.hpp"
#include "rprr_geometry/rgbd_frame.hpp"

namespace rprr {

/// A copy of the frame, for another process.
rprr_msgs::RgbdFrame to_message(const RgbdFrame& frame);

/// The frame back. Its pixels are copies of its own. Errors: a camera that makes no sense, counts
/// or colours that are not of its size, a unit that is not above 0.
Result<RgbdFramePtr> frame_from_message(const rprr_msgs::RgbdFrame& message);

}  // namespace rprr
