// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_geometry/se3.hpp"

namespace rprr {

/// How a camera moved between two of its own frames, from the frames alone: a robot need not know
/// its odometry.
struct CameraMotion {
  /// Values are those of rprr_msgs/CameraMotion.
  enum class Outcome : std::uint8_t {
    kUnknown = 0,  // too little depth, or a scene that looks the same from elsewhere
    kStill = 1,    // no more than noise
    kMoved = 2,
    kSceneChanged = 3,  // no motion explains both frames: it was large, or what is seen changed
  };
  Outcome outcome = Outcome::kUnknown;
  Pose later_from_earlier = Pose::Identity();  // with kStill and kMoved, optical
  double metres = 0.0;                         // how far the camera moved [m]
  double radians = 0.0;                        // how far it turned [rad]
  double overlap = 0.0;  // with kStill and kMoved: share of either view in the other, the less
};

/// Aligned coarse to fine at block resolution, from no motion and a few turns (tested up to 0.2 m
/// and 18 degrees), without a search. Frames that are not of their camera's size tell nothing.
CameraMotion camera_motion(const RgbdFrame& earlier, const RgbdFrame& later);

}  // namespace rprr
