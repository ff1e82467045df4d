// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/station_options.hpp"

namespace rprr {
namespace {

bool is_window(const OptionValue& value) {
  return std::get<int>(value) % 2 == 1;
}

void list_rebuilding(StationOptions& o, OptionTable& table) {
  constexpr OptionRange kShare = {0.0, 1.0};
  table.group("Rebuilding");
  table.word<Synthesis>("synthesis", o.synthesis.mode,
                        {{"backward", Synthesis::kBackward}, {"forward", Synthesis::kForward}},
                        "Colours of predicted pixels: fetched backward from the reference's image, "
                        "bilinearly, or carried forward with the depth pixel, as in the paper");
  table.flag("align", o.synthesis.align,
             "Fetch colours from where the reference looks like the base image, if there is one");
  table.number("surface_tolerance", o.synthesis.surface_tolerance, kShare, "",
               "A colour is fetched backward where the reference's depth is within this share");
  table.flag("mend_cracks", o.synthesis.crack_filter.cracks, "Mend cracks in the warped depth");
  table.flag("mend_ghosts", o.synthesis.crack_filter.ghosts, "Mend ghosts in the warped depth");
  table.number("mend_range", o.synthesis.crack_filter.range, kShare, "",
               "Depths within this share of each other are one surface");
  table
      .whole("mend_largest_window", o.synthesis.crack_filter.largest_window, {3, 9}, "pixels",
             "Cracks are narrower than this")
      .only_if(is_window, "3, 5, 7, 9 pixels");
  table.whole("edge_margin", o.stitch.edge_margin, {0, 8}, "pixels",
              "Predicted depth is dropped so near a depth edge, where it is mostly wrong");
  table.word<UnknownFill>("unknown_fill", o.stitch.fill,
                          {{"black", UnknownFill::kBlack}, {"smooth", UnknownFill::kSmooth}},
                          "Colour of pixels that were neither received nor predicted: spread from "
                          "around, or black as in the paper");
}

}  // namespace

void list_options(StationOptions& o, OptionTable& table) {
  table.group("The station");
  table.texts("robots", o.robots, "Robots that the station hears, at least one")
      .as_wiring()
      .only_if(are_robot_names, kRobotNamesRule);
  list_rebuilding(o, table);
  table.group("Bounds");
  table.whole("references_held", o.references_held, {1, 1000}, "frames",
              "Whole frames of a robot that are kept to predict from; a VGA frame takes 1.5 MB");
  table.whole("waiting", o.waiting, {0, 1000}, "frames",
              "Sparse frames of a robot that may wait for a reference on its way");
  table.seconds("wait_for_reference", o.wait_for_reference, {0.0, 3600.0},
                "How long a sparse frame waits for its reference");
  table.whole("largest_message", o.largest_message, {1, 1 << 30}, "bytes",
              "A longer encoded frame is refused unseen");
  table.whole("largest_image", o.largest_image, {64, 100000000}, "pixels",
              "A larger image is refused unseen");
  table.number("radio_bytes_per_second", o.energy.bytes_per_second, {1.0, 1e9}, "bytes/s",
               "Speed of the robots' radio, from which the energy of sending is estimated");
}

void list_options(StationOutputOptions& o, OptionTable& table) {
  table.group("What the station publishes");
  table.word<DepthEncoding>("depth_encoding", o.depth_encoding,
                            {{"auto", DepthEncoding::kAuto},
                             {"16UC1", DepthEncoding::kMillimetres},
                             {"32FC1", DepthEncoding::kMetres}},
                            "Depth images: 16UC1 (millimetres), 32FC1 (metres), or auto: 16UC1 "
                            "where a count is 1 mm");
  table.number("frustum_length", o.frustum_length, {0.01, 100.0}, "m",
               "Length of the pyramids on /station/frusta that show where cameras look");
  table.seconds("cloud_period", o.cloud_period, {0.0, 3600.0},
                "Least time between clouds on /station/points");
  table.whole("cloud_points", o.cloud_points, {1, 100000000}, "points",
              "A cloud on /station/points has no more; beyond, every view gives fewer rows and "
              "columns");
  table.whole("queue", o.queue, {1, 1000}, "messages",
              "Messages of a robot that may wait for the decoder; the newest are kept");
}

}  // namespace rprr
