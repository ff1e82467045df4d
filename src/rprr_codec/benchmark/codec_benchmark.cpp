// SPDX-License-Identifier: BSD-3-Clause
// Medians of processor time over the PNG images of folders in the layout of the TUM benchmark
// (depth/, rgb/):
//   rprr_codec_codec_benchmark FOLDER...
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "measure.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_codec/fill.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace {

namespace fs = std::filesystem;
using rprr::BlockGrid;
using rprr::BlockMask;
using rprr::benchmark::Clock;
using rprr::benchmark::images_in;
using rprr::benchmark::Times;

constexpr int kColourQuality = 6;

// A compact quarter of the blocks.
BlockMask quarter(const BlockGrid& grid) {
  BlockMask mask(grid);
  for (int block = 0; block < grid.count(); ++block) {
    mask.set(block, block % grid.columns < grid.columns / 2 && block < grid.count() / 2);
  }
  return mask;
}

// Every fourth block, none beside another.
BlockMask scattered(const BlockGrid& grid) {
  BlockMask mask(grid);
  for (int block = 0; block < grid.count(); ++block) {
    mask.set(block, block % grid.columns % 2 == 0 && block / grid.columns % 2 == 0);
  }
  return mask;
}

void benchmark_depth(const std::vector<cv::Mat>& images) {
  rprr::DhcmEncoder encoder;
  rprr::DhcmDecoder decoder;
  Times encoding;
  Times decoding;
  double raw = 0.0;
  double whole = 0.0;
  double region_bytes = 0.0;
  double scattered_bytes = 0.0;
  for (const cv::Mat& image : images) {
    const rprr::DepthFrame frame = {image, 0.001};
    const rprr::Bytes payload = encoding.measure([&] { return encoder.encode(frame); });
    decoding.measure([&] { return decoder.decode(payload); });
    raw += 2.0 * static_cast<double>(image.total());
    whole += static_cast<double>(payload.size());
    const BlockGrid grid(image.cols, image.rows);
    region_bytes += static_cast<double>(encoder.encode(frame, quarter(grid)).size());
    scattered_bytes += static_cast<double>(encoder.encode(frame, scattered(grid)).size());
  }
  std::printf(
      "  dhcm: %zu frames, ratio %.2f, encode %.2f ms, decode %.2f ms; bytes: whole %.0f, a "
      "quarter "
      "%.0f, every fourth block %.0f\n",
      images.size(), raw / whole, encoding.median(), decoding.median(),
      whole / static_cast<double>(images.size()), region_bytes / static_cast<double>(images.size()),
      scattered_bytes / static_cast<double>(images.size()));
}

void benchmark_colour(const std::vector<cv::Mat>& images) {
  const auto encoder = rprr::make_colour_encoder("pgf");
  const auto local = rprr::make_local_colour_decoder();
  const auto isolated = rprr::make_isolated_colour_decoder();
  rprr::SmoothFill smooth;
  Times encoding;
  Times here;
  Times apart(Clock::kWall);
  Times filling;
  double bytes = 0.0;
  for (const cv::Mat& image : images) {
    const rprr::Bytes payload =
        *encoding.measure([&] { return (*encoder)->encode(image, kColourQuality); });
    here.measure([&] { return local->decode("pgf", payload, image.size()); });
    apart.measure([&] { return isolated->decode("pgf", payload, image.size()); });
    filling.measure(
        [&] { return smooth.fill(image, scattered(BlockGrid(image.cols, image.rows))); });
    bytes += static_cast<double>(payload.size());
  }
  std::printf(
      "  pgf at quality %d: %.0f bytes, encode %.2f ms, decode %.2f ms, in the worker %.2f ms on "
      "the wall; "
      "smooth fill %.2f ms\n",
      kColourQuality, bytes / static_cast<double>(images.size()), encoding.median(), here.median(),
      apart.median(), filling.median());
}

}  // namespace

int main(int argc, char** argv) {
  const auto is_folder = [](const char* path) { return std::filesystem::is_directory(path); };
  if (argc < 2 || !std::all_of(argv + 1, argv + argc, is_folder)) {
    std::fprintf(stderr,
                 "Usage: rprr_codec_codec_benchmark FOLDER...\nTimes of the codecs over the PNG "
                 "images in depth/ and rgb/ of folders.\n");
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    const fs::path folder = argv[i];
    std::printf("%s\n", folder.c_str());
    const fs::path depth = fs::is_directory(folder / "depth") ? folder / "depth" : folder;
    const std::vector<cv::Mat> depths = images_in(depth);
    const std::vector<cv::Mat> colours = images_in(folder / "rgb");
    if (!depths.empty()) benchmark_depth(depths);
    if (!colours.empty()) benchmark_colour(colours);
  }
  return 0;
}
