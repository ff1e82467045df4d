// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/input_options.hpp"

namespace rprr {

void list_options(InputOptions& o, OptionTable& table) {
  table.group("This robot's camera");
  table.number("max_stamp_difference", o.max_stamp_difference, {0.0, 1.0}, "s",
               "How far apart the stamps of a colour and a depth image of one frame may be");
  table.number("depth_unit", o.depth_unit, {0.00001, 0.1}, "m",
               "Depth that a count stands for, into which 32FC1 depth is quantised: 0.0002 is "
               "exact for freiburg bags; 16UC1 depth is never rounded");
  table.text("image_transport", o.image_transport, "Transport of the camera's images")
      .only_if([](const OptionValue& value) { return !std::get<std::string>(value).empty(); },
               "raw or another transport of image_transport");
}

}  // namespace rprr
