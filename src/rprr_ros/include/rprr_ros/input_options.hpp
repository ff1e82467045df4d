// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/option_table.hpp"

namespace rprr {

/// How a robot's own camera is listened to.
struct InputOptions {
  double max_stamp_difference = 0.02;  ///< between colour and depth of one frame [s]
  DepthUnits depth{0.001, 0.0002};
  std::size_t largest_image = kLargestImage;  ///< [px]
  std::string image_transport = "raw";        ///< of colour
  std::string depth_transport = "raw";
};

void list_options(InputOptions& options, OptionTable& table);

}  // namespace rprr
