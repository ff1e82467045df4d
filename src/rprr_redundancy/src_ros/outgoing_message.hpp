// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/OutgoingFrame.h>

#include "rprr_ros/rgbd_subscriber.hpp"

namespace rprr {

/// The message that hands a frame to the encoder: whole, images and camera filled in.
rprr_msgs::OutgoingFramePtr outgoing_message(const RgbdFrame& frame, std::uint32_t exchange);

}  // namespace rprr
