// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/input_options.hpp"

namespace rprr {

void list_options(InputOptions& o, OptionTable& table) {
  table.group("This robot's camera");
  table.number("max_stamp_difference", o.max_stamp_difference, {0.0, 1.0}, "s",
               "How far apart the stamps of a colour and a depth image of one frame may be");
  table.number(
      "depth_scale", o.depth.of_counts, {0.00001, 0.1}, "m",
      "Depth that one count of 16UC1 images stands for: 0.001 as REP-118 says, 0.0001 with "
      "some drivers");
  table.number("depth_unit", o.depth.for_metres, {0.00001, 0.1}, "m",
               "Depth that a count stands for, into which 32FC1 depth is quantised: 0.0002 is "
               "exact for freiburg bags and reaches to 13.1 m; 16UC1 depth is never rounded");
  table.whole("largest_image", o.largest_image, {64, 100000000}, "pixels",
              "Larger images are not sent: the station would refuse them (the same option there)");
  const auto is_named = [](const OptionValue& value) {
    return !std::get<std::string>(value).empty();
  };
  table.text("image_transport", o.image_transport, "Transport of the camera's colour images")
      .only_if(is_named, "raw or another transport of image_transport, such as compressed or pgf");
  table.text("depth_transport", o.depth_transport, "Transport of the camera's depth images")
      .only_if(is_named,
               "raw or another transport of image_transport, such as compressedDepth or dhcm");
}

}  // namespace rprr
