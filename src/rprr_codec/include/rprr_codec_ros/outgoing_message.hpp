// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/OutgoingFrame.h>

#include <boost/shared_ptr.hpp>

#include "rprr_codec/outgoing_frame.hpp"
#include "rprr_ros/travels_as.hpp"

namespace rprr {

/// OutgoingFrame on /<robot>/rprr/outgoing. A copy of the frame, for another process.
rprr_msgs::OutgoingFrame to_message(const OutgoingFrame& outgoing);

/// The frame back. Where the message makes no sense there is no frame, and the reason says why.
void from_message(const rprr_msgs::OutgoingFrame& message, OutgoingFrame& outgoing);

using OutgoingFrameConstPtr = boost::shared_ptr<const OutgoingFrame>;

}  // namespace rprr

RPRR_TRAVELS_AS(rprr::OutgoingFrame, rprr_msgs::OutgoingFrame)
