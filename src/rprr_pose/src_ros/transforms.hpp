// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Transform.h>

#include "rprr_geometry/se3.hpp"

namespace rprr {

inline Pose from_transform(const geometry_msgs::Transform& transform) {
  return make_pose(
      {transform.translation.x, transform.translation.y, transform.translation.z},
      {transform.rotation.x, transform.rotation.y, transform.rotation.z, transform.rotation.w});
}

inline geometry_msgs::Transform to_transform(const Pose& pose) {
  geometry_msgs::Transform transform;
  const Eigen::Quaterniond q(pose.linear());
  transform.translation.x = pose.translation().x();
  transform.translation.y = pose.translation().y();
  transform.translation.z = pose.translation().z();
  transform.rotation.x = q.x();
  transform.rotation.y = q.y();
  transform.rotation.z = q.z();
  transform.rotation.w = q.w();
  return transform;
}

}  // namespace rprr
