// SPDX-License-Identifier: BSD-3-Clause
#include "encoder_options.hpp"

namespace rprr {

void list_options(EncoderOptions& o, OptionTable& table) {
  table.group("The robot");
  table.text("robot", o.robot, "This robot: /ROBOT/rprr/outgoing to /ROBOT/rprr/encoded")
      .as_wiring()
      .only_if([](const OptionValue& value) { return is_robot_name(std::get<std::string>(value)); },
               kRobotNameRule);
  table.number("depth_unit", o.depth_unit, {0.00001, 0.1}, "m",
               "Depth that a count stands for, in which 32FC1 depth is coded: 0.0002 is exact for "
               "freiburg bags; 16UC1 depth is never rounded");
  list_options(o.codec, table);
  list_options(o.sending, table);
}

OptionTable table_of(EncoderOptions& options) {
  return options_of(options);
}

}  // namespace rprr
