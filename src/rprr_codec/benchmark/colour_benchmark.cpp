// SPDX-License-Identifier: BSD-3-Clause
// Colour codecs over the images of folders in the layout of the TUM benchmark (rgb/):
//   rprr_codec_colour_benchmark FOLDER...
// Of each codec and quality: bytes, PSNR, and medians of milliseconds on one core; of sparse
// frames: bytes with the unsent blocks black, in place and compact; of the base: bytes with and
// without the blocks that are in the detail.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <random>
#include <string>
#include <vector>

#include "measure.hpp"
#include "rprr_codec/colour_layers.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace {

using namespace rprr;
using rprr::benchmark::Clock;
using rprr::benchmark::images_in;
using rprr::benchmark::Times;

constexpr int kRegions = 3;
constexpr int kDraws = 2;

struct Setting {
  std::string codec;
  std::vector<int> qualities;
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = {
      {"pgf", {4, 6, 8, 10, 12}}, {"jpeg", {10, 25, 50, 75}}, {"webp", {0, 10, 40, 75}}};
  return all;
}

double psnr(const cv::Mat& a, const cv::Mat& b) {
  const double error = cv::norm(a, b, cv::NORM_L2SQR) / (3.0 * static_cast<double>(a.total()));
  return 10.0 * std::log10(255.0 * 255.0 / std::max(error, 1e-9));
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// Connected regions that together hold about the share of all blocks, grown block by block.
BlockMask regions(const BlockGrid& grid, double share, std::uint32_t seed) {
  std::mt19937 random(seed);
  BlockMask mask(grid);
  const int each = std::max(1, static_cast<int>(share * grid.count() / kRegions));
  for (int region = 0; region < kRegions; ++region) {
    std::vector<int> rim = {static_cast<int>(random() % static_cast<unsigned>(grid.count()))};
    for (int grown = 0; grown < each && !rim.empty();) {
      std::swap(rim[random() % rim.size()], rim.back());
      const int block = rim.back();
      rim.pop_back();
      if (mask[block]) continue;
      mask.set(block);
      ++grown;
      const int column = block % grid.columns;
      const int row = block / grid.columns;
      if (column > 0) rim.push_back(block - 1);
      if (column + 1 < grid.columns) rim.push_back(block + 1);
      if (row > 0) rim.push_back(block - grid.columns);
      if (row + 1 < grid.rows) rim.push_back(block + grid.columns);
    }
  }
  return mask;
}

void whole_images(const std::vector<cv::Mat>& images, const std::string& codec, int quality) {
  const auto encoder = make_colour_encoder(codec);
  const auto local = make_local_colour_decoder();
  const auto isolated = make_isolated_colour_decoder();
  Times encoding, decoding, here(Clock::kWall), apart(Clock::kWall);
  std::vector<double> bytes, quality_db;
  for (const cv::Mat& image : images) {
    const Bytes payload = *encoding.measure([&] { return (*encoder)->encode(image, quality); });
    const auto decode = [&](ColourDecoder& decoder) {
      return decoder.decode(codec, payload, image.size());
    };
    decode(*isolated);  // starts the worker, warms both up
    const Result<cv::Mat> back = decoding.measure([&] { return decode(*local); });
    here.measure([&] { return decode(*local); });
    apart.measure([&] { return decode(*isolated); });
    bytes.push_back(static_cast<double>(payload.size()));
    quality_db.push_back(psnr(*back, image));
  }
  std::printf("  %-5s %4d %9.0f %7.2f %9.2f %9.2f %9.2f\n", codec.c_str(), quality, mean(bytes),
              mean(quality_db), encoding.median(), decoding.median(),
              apart.median() - here.median());
}

struct Layouts {
  std::vector<double> mask, black, in_place, compact, chosen;
};

// Payload bytes of one frame's blocks in each form.
void add_layouts(const cv::Mat& image, const BlockMask& mask, ColourEncoder& encoder, int quality,
                 ColourLayers& layers, Layouts& out) {
  const auto bytes_of = [&](const cv::Mat& picture) {
    return static_cast<double>(encoder.encode(picture, quality)->size());
  };
  SmoothFill smooth;
  const CompactLayout layout(mask);
  cv::Mat compact(layout.size(), CV_8UC3, cv::Scalar::all(0));
  layout.gather(image, compact);
  smooth.fill_in_place(compact, layout.used());
  out.mask.push_back(static_cast<double>(encode_mask(mask).size()));
  out.black.push_back(bytes_of(black_fill(image, mask)));
  out.in_place.push_back(bytes_of(smooth.fill(image, mask)));
  out.compact.push_back(bytes_of(compact));
  layers.prepare(image, &mask);
  out.chosen.push_back(static_cast<double>(layers.encode_detail(quality)->size()));
}

void sparse_images(const std::vector<cv::Mat>& images, const std::string& codec, int quality) {
  const auto encoder = make_colour_encoder(codec);
  auto layers = ColourLayers::create(codec, UnsentFill::kSmooth);
  for (const double share : {0.3, 0.1, 0.02}) {
    Layouts bytes;
    std::uint32_t seed = 1;
    for (const cv::Mat& image : images) {
      for (int draw = 0; draw < kDraws; ++draw) {
        const BlockMask mask = regions(BlockGrid(image.cols, image.rows), share, seed++);
        add_layouts(image, mask, **encoder, quality, *layers, bytes);
      }
    }
    std::printf("  %-5s %4d %5.2f %9.0f %9.0f %9.0f %9.0f %9.0f\n", codec.c_str(), quality, share,
                mean(bytes.mask), mean(bytes.black), mean(bytes.in_place), mean(bytes.compact),
                mean(bytes.chosen));
  }
}

void bases(const std::vector<cv::Mat>& images, const std::string& codec, int quality) {
  auto layers = ColourLayers::create(codec, UnsentFill::kSmooth);
  for (const int reduction : {1, 2, 4, 8}) {
    std::vector<double> complete, filled;
    std::uint32_t seed = 1;
    for (const cv::Mat& image : images) {
      const BlockMask mask = regions(BlockGrid(image.cols, image.rows), 0.3, seed++);
      layers->prepare(image, &mask);
      const auto bytes = [&](bool with_detail) {
        return static_cast<double>(layers->encode_base(reduction, quality, with_detail)->size());
      };
      complete.push_back(bytes(false));
      filled.push_back(bytes(true));
    }
    std::printf("  %-5s %4d %5d %9.0f %9.0f\n", codec.c_str(), quality, reduction, mean(complete),
                mean(filled));
  }
}

void filling(const std::vector<cv::Mat>& images) {
  SmoothFill smooth;
  Times times;
  cv::Mat picture;
  for (const cv::Mat& image : images) {
    const BlockMask mask = regions(BlockGrid(image.cols, image.rows), 0.3, 1);
    image.copyTo(picture);
    times.measure([&] { return smooth.fill_in_place(picture, mask), 0; });
  }
  std::printf("  smooth fill around 0.30 of the blocks: %.2f ms\n", times.median());
}

void benchmark_folder(const std::filesystem::path& folder) {
  const std::vector<cv::Mat> images = images_in(folder / "rgb");
  std::vector<cv::Mat> some;
  for (std::size_t i = 0; i < images.size(); i += 1 + images.size() / 12) {
    some.push_back(images[i]);
  }
  std::printf("%s: %zu images\n", folder.c_str(), images.size());
  if (images.empty()) return;
  std::printf("  codec qual     bytes    PSNR encode ms decode ms worker ms\n");
  for (const Setting& setting : settings()) {
    for (const int quality : setting.qualities) whole_images(images, setting.codec, quality);
  }
  std::printf("  codec qual share      mask     black  in place   compact    chosen\n");
  for (const Setting& setting : settings())
    sparse_images(some, setting.codec, setting.qualities[1]);
  std::printf("  codec qual   1/r  complete    filled\n");
  for (const Setting& setting : settings()) bases(some, setting.codec, setting.qualities[1]);
  filling(images);
}

}  // namespace

int main(int argc, char** argv) {
  const auto is_folder = [](const char* path) { return std::filesystem::is_directory(path); };
  if (argc < 2 || !std::all_of(argv + 1, argv + argc, is_folder)) {
    std::fprintf(stderr,
                 "Usage: rprr_codec_colour_benchmark FOLDER...\nColour codecs over the images in "
                 "rgb/ of folders in the layout of the TUM benchmark.\n");
    return 2;
  }
  cv::setNumThreads(1);
  for (int i = 1; i < argc; ++i) benchmark_folder(argv[i]);
  return 0;
}
