// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/ExchangeEvent.h>

#include <boost/shared_ptr.hpp>

#include "rprr_pose/exchange.hpp"
#include "rprr_ros/travels_as.hpp"

namespace rprr {

/// FrameDecision on /<robot>/rprr/exchange. A copy of the frame, for another process.
rprr_msgs::ExchangeEvent to_message(const FrameDecision& decision);

/// The decision back. Where the message makes no sense the decision has no frame, and its reason
/// says why.
void from_message(const rprr_msgs::ExchangeEvent& message, FrameDecision& decision);

using FrameDecisionConstPtr = boost::shared_ptr<const FrameDecision>;

}  // namespace rprr

RPRR_TRAVELS_AS(rprr::FrameDecision, rprr_msgs::ExchangeEvent)
