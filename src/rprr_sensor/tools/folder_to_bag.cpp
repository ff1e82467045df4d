// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>

#include "progress.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"
#include "rprr_sensor_ros/bag_writer.hpp"

namespace {

using rprr::BagShape;
using rprr::DepthEncoding;

struct Options {
  std::string folder;
  std::string bag;
  std::string robot = "eyebug_a";
  std::string shape = "rprr";
  std::string depth = "auto";
  std::string compression = "none";
  std::size_t start = 0;
  std::size_t count = 0;
  std::size_t stride = 1;
  double window = 0.02;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("folder", options.folder, "folder in the layout of the TUM RGB-D benchmark")
      ->required();
  app.add_option("bag", options.bag, "bag to write")->required();
  app.add_option("--robot", options.robot, "robot that the topics belong to (shape rprr)")
      ->capture_default_str();
  app.add_option("--shape", options.shape,
                 "rprr: our topics; tum: topics, frames and /tf of the benchmark's bags")
      ->check(CLI::IsMember({"rprr", "tum"}))
      ->capture_default_str();
  app.add_option("--depth", options.depth,
                 "auto: 16UC1 where the folder's unit is 1 mm, else 32FC1 (shape rprr)")
      ->check(CLI::IsMember({"auto", "16UC1", "32FC1"}))
      ->capture_default_str();
  app.add_option("--compress", options.compression, "none, bz2 or lz4")
      ->check(CLI::IsMember({"none", "bz2", "lz4"}))
      ->capture_default_str();
  app.add_option("--start", options.start, "index of the first entry")->capture_default_str();
  app.add_option("--count", options.count, "number of entries at most; 0: all")
      ->capture_default_str();
  app.add_option("--stride", options.stride, "take every Nth entry")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--window", options.window,
                 "seconds between colour and depth that belong together")
      ->capture_default_str();
}

/// Entries to write; their stamps moved by a second if the first is 0, which no bag can hold.
std::vector<rprr::RgbdEntry> chosen_entries(const rprr::TumFolder& folder, const Options& options) {
  std::vector<rprr::RgbdEntry> chosen;
  const rprr::Stamp shift = folder.entries.front().stamp == 0 ? rprr::from_seconds(1.0) : 0;
  for (std::size_t k = options.start; k < folder.entries.size(); k += options.stride) {
    if (options.count > 0 && chosen.size() == options.count) break;
    chosen.push_back(folder.entries[k]);
    chosen.back().stamp += shift;
    chosen.back().depth_stamp += shift;
  }
  return chosen;
}

DepthEncoding encoding_of(const std::string& name) {
  if (name == "16UC1") return DepthEncoding::millimetres;
  return name == "32FC1" ? DepthEncoding::metres : DepthEncoding::automatic;
}

int convert(const Options& options) {
  rprr::TumFolderOptions folder_options;
  folder_options.association_window_s = options.window;
  const auto folder = rprr::open_tum_folder(options.folder, folder_options);
  if (!folder) return rprr::fail(folder.reason());
  if (!folder->remark.empty()) std::cerr << "note: " << folder->remark << "\n";
  const auto entries = chosen_entries(*folder, options);
  if (entries.empty()) return rprr::fail("--start lies behind the last entry");
  const BagShape shape = options.shape == "tum" ? BagShape::tum : BagShape::rprr;
  const DepthEncoding encoding = encoding_of(options.depth);
  if (shape == BagShape::rprr && encoding == DepthEncoding::millimetres &&
      folder->depth_unit != 0.001) {
    return rprr::fail("the folder's depth unit is not 1 mm, 16UC1 would round it; use 32FC1");
  }
  auto bag = rprr::BagWriter::create(options.bag, options.compression);
  if (!bag) return rprr::fail(bag.reason());
  std::size_t left_out = 0;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    auto image = folder->load(entries[k]);
    if (!image) {
      std::cerr << "\nleft out: " << image.reason() << "\n";
      ++left_out;
      continue;
    }
    const rprr::RecordedFrame frame{entries[k].stamp, *image, entries[k].world_from_camera,
                                    entries[k].depth_stamp};
    const auto written = bag->add(frame, folder->camera, options.robot, shape, encoding);
    if (!written) return rprr::fail(written.reason());
    rprr::show_progress(k + 1, entries.size());
  }
  if (left_out == entries.size()) return rprr::fail("no entry could be read: no bag is written");
  const auto finished = bag->finish();
  if (!finished) return rprr::fail(finished.reason());
  if (left_out == 0) return 0;
  return rprr::fail(std::to_string(left_out) + " of " + std::to_string(entries.size()) +
                    " entries left out, for the reasons above; the others are in the bag");
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Turns a folder of RGB-D images into a bag. Depth keeps its exact values."};
  Options options;
  declare(app, options);
  CLI11_PARSE(app, argc, argv);
  return convert(options);
} catch (const std::exception& error) {  // of a library: ends with a sentence
  return rprr::fail(error.what());
}
