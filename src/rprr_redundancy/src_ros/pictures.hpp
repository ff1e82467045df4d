// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <string>

#include "rprr_redundancy/redundancy.hpp"

namespace rprr {

/// What people can look at of the redundancy stage. Each is made only while somebody listens. One
/// thread at a time.
class Pictures {
 public:
  Pictures(ros::NodeHandle& nh, const std::string& robot);

  /// B_v of one of the robot's frames: topic `validation`.
  void show(const ValidatedBlocks& blocks);
  /// What goes out of a frame: topics `mask`, `sparse/rgb` and `sparse/depth`.
  void show(const OutgoingFrame& outgoing);
  /// The dependent's preview with what it was asked for, and its points: topics `decision` and
  /// `preview_points`. Both are images of the dependent, so they lie in its frames.
  void show(const BlockRequest& request);

 private:
  ros::Publisher validation_, mask_, rgb_, depth_, decision_, points_;
};

}  // namespace rprr
