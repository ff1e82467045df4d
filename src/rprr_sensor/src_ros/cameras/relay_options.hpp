// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_geometry/option_table.hpp"

namespace rprr {

/// All private parameters of rprr_sensor/CameraRelay: config/camera_relay.yaml. The topics are
/// those of freenect_launch and openni2_launch with depth_registration:=true.
struct RelayOptions {
  std::string robot = "eyebug_a";
  std::string rgb_topic = "/camera/rgb/image_rect_color";
  std::string camera_info_topic = "/camera/rgb/camera_info";
  std::string depth_topic = "/camera/depth_registered/hw_registered/image_rect_raw";
};

void list_options(RelayOptions& options, OptionTable& table);

}  // namespace rprr
