// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_geometry/option_table.hpp"

namespace rprr {

/// How a robot's own camera is listened to.
struct InputOptions {
  double max_stamp_difference = 0.02;  ///< between colour and depth of one frame [s]
  double depth_unit = 0.0002;          ///< that 32FC1 depth is quantised to [m per count]
  std::string image_transport = "raw";
};

void list_options(InputOptions& options, OptionTable& table);

}  // namespace rprr
