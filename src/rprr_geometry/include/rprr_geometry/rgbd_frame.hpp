// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// One moment of one robot's camera: colour and depth, registered and of equal size. Every stage
/// on the robot sees the same object: it is made once, shared by pointer and never written to.
struct RgbdFrame {
  Stamp stamp = 0;       ///< of the colour image; names the frame
  std::string frame_id;  ///< optical frame (REP-103: x right, y down, z forward)
  Camera camera;         ///< float32 intrinsics, as they cross the radio
  DepthFrame depth;      ///< of the camera's size
  cv::Mat bgr;           ///< CV_8UC3 of the camera's size; may be empty where no stage needs colour
  std::shared_ptr<const void> owner;  ///< keeps the pixels alive where they belong to others
};
using RgbdFramePtr = std::shared_ptr<const RgbdFrame>;

}  // namespace rprr
