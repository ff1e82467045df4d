// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/player_options.hpp"

namespace rprr {
namespace {

void list_source(PlayerOptions& o, OptionTable& table) {
  constexpr OptionRange kPixels = {0.0, 10000.0};
  constexpr OptionRange kCentre = {-1.0, 10000.0};
  table.group("What is read");
  table.number("association_window", o.recording.association_window_s, {0.0, 10.0}, "s",
               "Most time between a colour and a depth image that belong together");
  table.number("depth_scale", o.recording.depth.of_counts, {0.00001, 0.1}, "m",
               "Depth that one count of a bag's 16UC1 images stands for");
  table.number("depth_unit", o.recording.depth.for_metres, {0.00001, 0.1}, "m",
               "Depth that a count stands for, which a bag's 32FC1 depth becomes; TUM: 0.0002");
  table.text("colour_topic", o.recording.colour_topic, "Of a bag; empty: found by its name");
  table.text("depth_topic", o.recording.depth_topic, "Of a bag; empty: found by its name");
  table.number("fx", o.fx, kPixels, "pixels",
               "Above 0: this and the following intrinsics count instead of the source's");
  table.number("fy", o.fy, kPixels, "pixels", "0: as fx");
  table.number("cx", o.cx, kCentre, "pixels", "Below 0: the image's centre");
  table.number("cy", o.cy, kCentre, "pixels", "Below 0: the image's centre");
  table.whole("width", o.width, {1, 10000}, "pixels", "Of the images, with fx");
  table.whole("height", o.height, {1, 10000}, "pixels", "Of the images, with fx");
}

}  // namespace

void list_options(PlayerOptions& o, OptionTable& table) {
  constexpr OptionRange kEntries = {0, 1000000};
  table.group("What is played");
  table.text("source", o.source, "Folder in the TUM layout, or bag of one camera; it must be set");
  table.robot("a", o.a, "Robot that entry k plays");
  table.robot("b", o.b, "Robot that entry k + step plays");
  table.whole("step", o.schedule.step, kEntries, "entries", "From a to b");
  table.whole("start", o.schedule.start, kEntries, "entries", "First entry that a plays");
  table.whole("count", o.schedule.count, kEntries, "pairs", "In a round; 0: as many as there are");
  table.flag("loop", o.schedule.loop, "Begin again after the last pair");
  table.group("When it is played");
  table.number("rate", o.rate, {0.0, 1000.0}, "pairs/s",
               "At most; 0: as fast as the handshake, else one for each call of ~next");
  table.flag("handshake", o.handshake,
             "Wait for /station/statistics of b's frame before the next pair");
  table.number("handshake_timeout", o.handshake_timeout, {0.0, 3600.0}, "s",
               "Wall time until an answer is given up");
  table.whole("wait_for_subscribers", o.wait_for_subscribers, {0, 1000}, "subscribers",
              "On every camera topic of both robots before the first pair");
  table.number("wait_timeout", o.wait_timeout, {-1.0, 86400.0}, "s",
               "Wall time until playing starts without them; below 0: never");
  table.flag("required", o.required,
             "End the process, and with it a launch that requires it, where there is nothing to "
             "play; not for a nodelet manager that others use");
  list_source(o, table);
}

std::string complete(PlayerOptions& o) {
  if (o.source.empty()) {
    return "source: \"\" is not, allowed: a folder in the TUM layout or a bag of one camera";
  }
  if (o.a == o.b) return "b: " + o.b + " is not, allowed: another robot than a";
  if (o.fx <= 0.0) return {};
  Camera camera{o.width, o.height, o.fx, o.fy > 0.0 ? o.fy : o.fx, o.cx, o.cy};
  if (camera.cx < 0.0) camera.cx = 0.5 * (camera.width - 1);
  if (camera.cy < 0.0) camera.cy = 0.5 * (camera.height - 1);
  if (!camera.valid()) return "fx, fy, cx, cy, width and height do not make a camera";
  o.recording.camera = camera;
  return {};
}

}  // namespace rprr
