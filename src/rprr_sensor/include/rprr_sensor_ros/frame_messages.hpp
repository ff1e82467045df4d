// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/time.h>

#include <string>

#include "rprr_geometry/se3.hpp"

namespace rprr {

/// Where a robot's camera publishes.
struct InputTopics {
  std::string colour;
  std::string camera_info;
  std::string depth;
  std::string pose;  // the camera's true pose in the world, where known
};

/// RPRR's fixed inputs, /<robot>/camera/...
InputTopics input_topics(const std::string& robot);
/// The topics of the TUM benchmark's bags; their poses are on /tf.
InputTopics tum_topics();

/// Pose of the colour camera's optical frame in the frame "world".
geometry_msgs::PoseStamped pose_message(const ros::Time& stamp, const Pose& world_from_camera);

}  // namespace rprr
