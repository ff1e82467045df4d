// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "rprr_geometry/option_table.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_sensor/cameras/device_session.hpp"
#include "rprr_sensor/cameras/raw_disparity.hpp"

namespace rprr {

/// All private parameters of rprr_sensor/Freenect and rprr_sensor/OpenNI2: config/rgbd_camera.yaml.
struct CameraOptions {
  std::string robot = "eyebug_a";
  std::string frame_id;  // empty: <robot>_rgb_optical_frame
  SessionOptions session;
  std::string camera_info_url;
  std::string depth_info_url;
  /// A point p of the depth camera is R p + t of the colour camera.
  std::array<double, 3> depth_to_colour_translation = {-0.025, 0.0, 0.0};  // t, metres
  std::array<double, 3> depth_to_colour_rotation = {0.0, 0.0, 0.0};  // R: roll, pitch, yaw, radians
  DisparityModel disparity;
  bool paused = false;
  int every_nth = 1;
  double max_rate = 0.0;  // pairs a second; 0: no limit
};

/// Live: the controls, every_nth, max_rate.
void list_options(CameraOptions& options, OptionTable& table);

/// The depth camera in the colour camera's frame.
Pose colour_from_depth(const CameraOptions& options);

}  // namespace rprr
