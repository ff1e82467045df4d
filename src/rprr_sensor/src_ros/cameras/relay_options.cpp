// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/relay_options.hpp"

namespace rprr {
namespace {

bool is_not_empty(const OptionValue& value) {
  return !std::get<std::string>(value).empty();
}

}  // namespace

void list_options(RelayOptions& o, OptionTable& table) {
  table.robot("robot", o.robot, "Whose topics they become").as_wiring();
  table.text("rgb_topic", o.rgb_topic, "Rectified colour").only_if(is_not_empty, "a topic");
  table.text("camera_info_topic", o.camera_info_topic, "Its camera_info")
      .only_if(is_not_empty, "a topic");
  table.text("depth_topic", o.depth_topic, "Depth registered to colour, 16UC1 or 32FC1")
      .only_if(is_not_empty, "a topic");
}

}  // namespace rprr
