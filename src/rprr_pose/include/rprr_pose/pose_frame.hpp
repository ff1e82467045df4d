// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// What the pose stage sees of one robot's frame. Immutable once shared.
struct PoseFrame {
  Stamp stamp = 0;       // names the frame
  std::string frame_id;  // optical frame
  Camera camera;         // float32 intrinsics, as they cross the radio
  DepthFrame depth;      // of the camera's size
  cv::Mat bgr;           // CV_8UC3 of the camera's size; may be empty: `samples` needs no colour
  std::shared_ptr<const void> owner;  // keeps the pixels alive
};
using PoseFramePtr = std::shared_ptr<const PoseFrame>;

}  // namespace rprr
