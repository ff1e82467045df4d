// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/BlockPreview.h>
#include <rprr_msgs/PoseUpdate.h>
#include <rprr_msgs/RelativePose.h>
#include <rprr_msgs/SamplePoints.h>

#include "rprr_pose/exchange.hpp"
#include "rprr_pose/messages.hpp"

namespace rprr {

/// Core messages <-> what crosses the radio. Nothing is checked here but that enums stay in range:
/// the roles do not trust what they get.
rprr_msgs::SamplePoints to_ros(const SamplesMessage& message);
rprr_msgs::PoseUpdate to_ros(const UpdateMessage& message);
rprr_msgs::RelativePose to_ros(const RelativePoseMessage& message);
rprr_msgs::BlockPreview to_ros(const PreviewMessage& message);
SamplesMessage from_ros(const rprr_msgs::SamplePoints& message);
UpdateMessage from_ros(const rprr_msgs::PoseUpdate& message);
PreviewMessage from_ros(const rprr_msgs::BlockPreview& message);
RelativePoseMessage from_ros(const rprr_msgs::RelativePose& message);

}  // namespace rprr
