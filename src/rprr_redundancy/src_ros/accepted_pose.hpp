// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/ExchangeEvent.h>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

/// What an exchange found out about the other robot: how it stands and what its camera is.
struct AcceptedPose {
  Pose m_ab;           // reference to dependent
  Camera peer_camera;  // the other robot's
};

/// Reads an event that asks to predict or to send sparsely; errors are words for people.
Result<AcceptedPose> read_accepted_pose(const rprr_msgs::ExchangeEvent& event);

}  // namespace rprr
