// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "commands.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_eval/metrics.hpp"
#include "rprr_eval/summary.hpp"
#include "rprr_sensor/tum_folder.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

struct CodecArguments {
  std::vector<std::string> folders;
  std::string json;
  int quality = 6;
  int repeats = 3;
};

struct Images {
  std::vector<DepthFrame> depth;
  std::vector<cv::Mat> bgr;
};

// One frame through one codec.
struct Trip {
  std::size_t bytes = 0;
  double encode_ms = 0.0;
  double decode_ms = 0.0;
  bool lossless = false;
  double psnr = 99.0;
};

double milliseconds(const std::function<void()>& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

bool same(const cv::Mat& left, const cv::Mat& right) {
  return left.size() == right.size() && left.type() == right.type() &&
         cv::norm(left, right, cv::NORM_INF) == 0.0;
}

// A TUM-layout folder, or any folder with 16-bit PNG images in it.
Result<Images> read_images(const std::string& path) {
  Images images;
  if (fs::exists(path + "/associations.txt") || fs::exists(path + "/depth.txt")) {
    const Result<TumFolder> folder = open_tum_folder(path);
    if (!folder) return Error{folder.reason()};
    for (const RgbdEntry& entry : folder->entries) {
      const Result<RgbdImage> image = folder->load(entry);
      if (!image) return Error{image.reason()};
      images.depth.push_back(image->depth);
      images.bgr.push_back(image->bgr);
    }
    return images;
  }
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(path, error)) {
    if (file.path().extension() == ".png") files.push_back(file.path().string());
  }
  if (error) return Error{path + ": " + error.message()};
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    const cv::Mat image = cv::imread(file, cv::IMREAD_UNCHANGED);
    if (image.type() == CV_16UC1) images.depth.push_back({image, 0.001});
  }
  if (images.depth.empty()) return Error{path + " holds no depth images (16-bit PNG)"};
  return images;
}

Trip dhcm_trip(DhcmEncoder& encoder, DhcmDecoder& decoder, const DepthFrame& frame) {
  Trip trip;
  Bytes bytes;
  trip.encode_ms = milliseconds([&] { bytes = encoder.encode(frame); });
  trip.bytes = bytes.size();
  trip.decode_ms = milliseconds([&] {
    const Result<DepthFrame> back = decoder.decode(bytes);
    trip.lossless = back && same(back->counts, frame.counts);
  });
  return trip;
}

Trip png_trip(const DepthFrame& frame) {
  Trip trip;
  Bytes bytes;
  trip.encode_ms = milliseconds([&] {
    cv::imencode(".png", frame.counts, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
  });
  trip.bytes = bytes.size();
  cv::Mat back;
  trip.decode_ms = milliseconds([&] { back = cv::imdecode(bytes, cv::IMREAD_UNCHANGED); });
  trip.lossless = same(back, frame.counts);
  return trip;
}

Trip colour_trip(ColourEncoder& encoder, ColourDecoder& decoder, const cv::Mat& bgr) {
  Trip trip;
  Result<Bytes> bytes = Error{"not encoded"};
  trip.encode_ms = milliseconds([&] { bytes = encoder.encode(bgr); });
  if (!bytes) return trip;
  trip.bytes = bytes->size();
  Result<cv::Mat> back = Error{"not decoded"};
  trip.decode_ms = milliseconds([&] { back = decoder.decode(encoder.name(), *bytes, bgr.size()); });
  trip.psnr = back ? *psnr(*back, bgr) : 0.0;
  trip.lossless = back && same(*back, bgr);
  return trip;
}

// Medians over frames of the best of a few repeats each.
template <typename Image>
nlohmann::json measure(const std::string& codec, const std::string& folder,
                       const std::vector<Image>& images, double raw_bytes_per_pixel, int repeats,
                       const std::function<Trip(const Image&)>& trip) {
  std::vector<double> encode, decode, quality, ratio;
  bool lossless = true;
  for (const Image& image : images) {
    Trip best = trip(image);
    for (int i = 1; i < repeats; ++i) {
      const Trip again = trip(image);
      best.encode_ms = std::min(best.encode_ms, again.encode_ms);
      best.decode_ms = std::min(best.decode_ms, again.decode_ms);
    }
    encode.push_back(best.encode_ms);
    decode.push_back(best.decode_ms);
    quality.push_back(best.psnr);
    lossless = lossless && best.lossless;
    double pixels = 0.0;
    if constexpr (std::is_same_v<Image, cv::Mat>) {
      pixels = static_cast<double>(image.total());
    } else {
      pixels = static_cast<double>(image.counts.total());
    }
    ratio.push_back(pixels * raw_bytes_per_pixel / static_cast<double>(best.bytes));
  }
  nlohmann::json line = {{"codec", codec},
                         {"folder", folder},
                         {"frames", images.size()},
                         {"ratio", median(ratio)},
                         {"encode_ms", median(encode)},
                         {"decode_ms", median(decode)},
                         {"lossless", lossless}};
  if (!lossless) line["psnr"] = median(quality);
  return line;
}

int run_codec(const CodecArguments& arguments) {
  cv::setNumThreads(1);  // figures are per core
  std::ofstream file;
  if (!arguments.json.empty()) file.open(arguments.json);
  if (!arguments.json.empty() && !file) {
    return std::cerr << "cannot write " << arguments.json << "\n", 1;
  }
  std::ostream& out = arguments.json.empty() ? std::cout : file;
  auto colour = make_colour_encoder("pgf", arguments.quality);
  if (!colour) return std::cerr << colour.reason() << "\n", 1;
  const auto colour_decoder = make_local_colour_decoder();
  DhcmEncoder encoder;
  DhcmDecoder decoder;
  for (const std::string& path : arguments.folders) {
    const Result<Images> images = read_images(path);
    if (!images) return std::cerr << images.reason() << "\n", 1;
    const std::string name = fs::path(path + "/").parent_path().filename().string();
    std::cerr << name << ": " << images->depth.size() << " frames\n";
    out << measure<DepthFrame>(
               "dhcm", name, images->depth, 2.0, arguments.repeats,
               [&](const DepthFrame& frame) { return dhcm_trip(encoder, decoder, frame); })
        << std::endl;
    out << measure<DepthFrame>("png6", name, images->depth, 2.0, arguments.repeats, png_trip)
        << std::endl;
    if (images->bgr.empty()) continue;
    out << measure<cv::Mat>(
               "pgf" + std::to_string(arguments.quality), name, images->bgr, 3.0, arguments.repeats,
               [&](const cv::Mat& bgr) { return colour_trip(**colour, *colour_decoder, bgr); })
        << std::endl;
  }
  return 0;
}

}  // namespace

void add_codec_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CodecArguments>();
  CLI::App* command = app.add_subcommand(
      "codec",
      "Codecs over folders of frames: ratio to raw (16-bit depth, 24-bit colour), medians of "
      "milliseconds a frame, one JSON object a line");
  command->add_option("folder", arguments->folders, "TUM-layout folders, or folders of 16-bit PNG")
      ->required();
  command->add_option("--quality", arguments->quality, "of PGF, 0 (lossless) to 30")
      ->capture_default_str();
  command->add_option("--repeats", arguments->repeats, "best of so many runs for each frame")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->callback([arguments, &exit_code] { exit_code = run_codec(*arguments); });
}

}  // namespace rprr
