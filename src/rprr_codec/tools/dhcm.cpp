// SPDX-License-Identifier: BSD-3-Clause
// Depth images to DHC-M files and back: rosrun rprr_codec dhcm encode|decode|info.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <opencv2/core.hpp>

#include "depth_files.hpp"
#include "file_jobs.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".dhcm";

struct Arguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string mode = "default";
  std::string raw;
  bool metres = false;
  bool verify = false;
  bool force = false;
  bool to_raw = false;
  double unit = 0.001;
  double step = 0.0;
};

std::size_t largest_payload() {
  return dhcm_bound({kMaxImageSide, kMaxImageSide}, DhcmPixels::kFloat);
}

std::size_t bytes_of(const cv::Mat& pixels) {
  return pixels.total() * pixels.elemSize();
}

// "640x480"; nothing where nothing is said.
Result<std::optional<RawLayout>> raw_layout(const Arguments& arguments) {
  if (arguments.raw.empty()) return std::optional<RawLayout>();
  RawLayout layout;
  int length = 0;
  const int read = std::sscanf(arguments.raw.c_str(), "%5dx%5d%n", &layout.size.width,
                               &layout.size.height, &length);
  if (read != 2 || static_cast<std::size_t>(length) != arguments.raw.size() ||
      layout.size.width < 1 || layout.size.height < 1 || layout.size.width > kMaxImageSide ||
      layout.size.height > kMaxImageSide) {
    return Error{"--raw wants WIDTHxHEIGHT, each 1 to " + std::to_string(kMaxImageSide) + ", not " +
                 arguments.raw};
  }
  layout.metres = arguments.metres;
  return std::optional<RawLayout>(layout);
}

// --- encode

Result<Bytes> encode_pixels(DhcmEncoder& encoder, const cv::Mat& pixels,
                            const Arguments& arguments) {
  if (pixels.type() == CV_32FC1) return encoder.encode_float(pixels, arguments.step);
  return encoder.encode({pixels, arguments.unit});
}

// What was written says the same as what was read.
Result<bool> verify(DhcmDecoder& decoder, const Bytes& payload, const cv::Mat& pixels,
                    double step) {
  if (pixels.type() == CV_16UC1) {
    const Result<DepthFrame> back = decoder.decode(payload);
    if (!back) return Error{"verification: " + back.reason()};
    if (cv::norm(back->counts, pixels, cv::NORM_INF) != 0.0) return Error{"verification failed"};
    return true;
  }
  const Result<cv::Mat> back = decoder.decode_float(payload);
  if (!back) return Error{"verification: " + back.reason()};
  if (step > 0.0) {
    const cv::Mat readings = (pixels > 0.0f) & (pixels < 1e30f);
    const double off = cv::norm(*back, pixels, cv::NORM_INF, readings);
    if (!(off <= 0.5001 * step + 1e-6)) return Error{"verification failed"};
  } else if (std::memcmp(back->data, pixels.data, bytes_of(pixels)) != 0) {
    return Error{"verification failed"};
  }
  return true;
}

int run_encode(const Arguments& arguments) {
  const auto layout = raw_layout(arguments);
  const Result<DhcmMode> mode = dhcm_mode_from_name(arguments.mode);
  const std::string problem = !layout ? layout.reason() : mode.reason();
  if (!problem.empty()) return std::cerr << "error: " << problem << "\n", 1;
  const auto jobs =
      plan_jobs(arguments.inputs, arguments.output, kEnding, [&](const fs::path& path) {
        return is_image_name(path) || (*layout && path.extension() == ".raw");
      });
  if (!jobs) return std::cerr << "error: " << jobs.reason() << "\n", 1;
  DhcmEncoder encoder(*mode);
  DhcmDecoder decoder;
  return run_jobs(*jobs, "encoded", [&](const FileJob& job) -> Result<JobSizes> {
    const Result<cv::Mat> pixels = read_depth(job.in, *layout);
    if (!pixels) return Error{pixels.reason()};
    const Result<bool> prepared = prepare_output(job.out, arguments.force);
    if (!prepared) return Error{prepared.reason()};
    const Result<Bytes> payload = encode_pixels(encoder, *pixels, arguments);
    if (!payload) return Error{payload.reason()};
    if (arguments.verify) {
      const Result<bool> good = verify(decoder, *payload, *pixels, arguments.step);
      if (!good) return Error{good.reason()};
    }
    const Result<bool> written = write_file(job.out, *payload);
    if (!written) return Error{written.reason()};
    return JobSizes{bytes_of(*pixels), payload->size()};
  });
}

// --- decode

Result<cv::Mat> decode_pixels(DhcmDecoder& decoder, const Bytes& payload) {
  const Result<DhcmInfo> info = dhcm_info(payload);
  if (!info) return Error{info.reason()};
  if (info->masked) return Error{"holds only some blocks, and which ones it does not say"};
  if (info->pixels != DhcmPixels::kCounts) return decoder.decode_float(payload);
  Result<DepthFrame> frame = decoder.decode(payload);
  if (!frame) return Error{frame.reason()};
  return frame->counts;
}

int run_decode(const Arguments& arguments) {
  const auto jobs = plan_jobs(arguments.inputs, arguments.output, "",
                              [](const fs::path& path) { return path.extension() == kEnding; });
  if (!jobs) return std::cerr << "error: " << jobs.reason() << "\n", 1;
  DhcmDecoder decoder;
  return run_jobs(*jobs, "decoded", [&](const FileJob& job) -> Result<JobSizes> {
    const Result<Bytes> payload = read_file(job.in, largest_payload());
    if (!payload) return Error{payload.reason()};
    const Result<cv::Mat> pixels = decode_pixels(decoder, *payload);
    if (!pixels) return Error{pixels.reason()};
    fs::path out = job.out;
    if (!job.named) {
      out += arguments.to_raw ? ".raw" : pixels->type() == CV_16UC1 ? ".png" : ".tiff";
    }
    const Result<bool> prepared = prepare_output(out, arguments.force);
    if (!prepared) return Error{prepared.reason()};
    const Result<bool> written = write_depth(out, *pixels);
    if (!written) return Error{written.reason()};
    return JobSizes{bytes_of(*pixels), payload->size()};
  });
}

// --- info

std::string pixels_of(const DhcmInfo& info) {
  char text[64];
  switch (info.pixels) {
    case DhcmPixels::kFloat:
      return "metres, float32, lossless";
    case DhcmPixels::kQuantisedFloat:
      std::snprintf(text, sizeof(text), "metres, float32, in steps of %g m", info.unit);
      return text;
    case DhcmPixels::kCounts:
      break;
  }
  std::snprintf(text, sizeof(text), "counts of %g m, lossless", info.unit);
  return text;
}

Result<JobSizes> print_info(const FileJob& job) {
  const Result<Bytes> payload = read_file(job.in, largest_payload());
  if (!payload) return Error{payload.reason()};
  const Result<DhcmInfo> info = dhcm_info(*payload);
  if (!info) return Error{info.reason()};
  const std::size_t width = info->pixels == DhcmPixels::kCounts ? 2 : 4;
  const JobSizes sizes = {
      width * static_cast<std::size_t>(info->width) * static_cast<std::size_t>(info->height),
      payload->size()};
  std::printf("%s: %dx%d, %s, %s%s%s, %zu bytes, ratio %.2f\n", job.in.c_str(), info->width,
              info->height, pixels_of(*info).c_str(), dhcm_mode_name(info->mode),
              info->stored ? ", stored" : "", info->masked ? ", some blocks only" : "", sizes.coded,
              static_cast<double>(sizes.raw) / static_cast<double>(sizes.coded));
  return sizes;
}

int run_info(const Arguments& arguments) {
  const auto jobs = plan_jobs(arguments.inputs, "", kEnding,
                              [](const fs::path& path) { return path.extension() == kEnding; });
  if (!jobs) return std::cerr << "error: " << jobs.reason() << "\n", 1;
  return run_jobs(*jobs, "looked at", print_info);
}

// --- command line

void add_files(CLI::App& command, Arguments& arguments, bool writes) {
  command.add_option("input", arguments.inputs, "files, or folders with all that is below them")
      ->required();
  if (!writes) return;
  command.add_option("-o,--output", arguments.output,
                     "folder, or the name of a single file; beside the inputs if not given");
  command.add_flag("-f,--force", arguments.force, "replace files that are there");
}

void add_commands(CLI::App& app, Arguments& arguments, int& exit_code) {
  CLI::App* encode = app.add_subcommand(
      "encode", "16-bit PNG, PGM or TIFF, float TIFF (metres) and raw files to .dhcm");
  add_files(*encode, arguments, true);
  encode
      ->add_option("-m,--mode", arguments.mode,
                   "fast, default or small: speed against size; all are lossless")
      ->check(CLI::IsMember({"fast", "default", "small"}))
      ->capture_default_str();
  encode
      ->add_option("--unit", arguments.unit,
                   "metres per count of 16-bit images; only noted in the file")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  encode
      ->add_option("--step", arguments.step,
                   "round float depth to whole steps of this many metres; 0 is lossless")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  CLI::Option* raw = encode->add_option(
      "--raw", arguments.raw,
      "WIDTHxHEIGHT of raw files: little-endian uint16, no header; in folders those named .raw");
  encode->add_flag("--metres", arguments.metres, "raw files hold float32 metres instead")
      ->needs(raw);
  encode->add_flag("--verify", arguments.verify, "decode again and compare before writing");
  encode->callback([&] { exit_code = run_encode(arguments); });

  CLI::App* decode = app.add_subcommand(
      "decode", ".dhcm files to PNG (counts) and TIFF (float metres), or raw files");
  add_files(*decode, arguments, true);
  decode->add_flag("--raw", arguments.to_raw, "write little-endian pixels without a header");
  decode->callback([&] { exit_code = run_decode(arguments); });

  CLI::App* info = app.add_subcommand("info", "prints what .dhcm files say about themselves");
  add_files(*info, arguments, false);
  info->callback([&] { exit_code = run_info(arguments); });
}

}  // namespace
}  // namespace rprr

int main(int argc, char** argv) {
  CLI::App app("Depth images to DHC-M files and back, losslessly");
  app.require_subcommand(1);
  rprr::Arguments arguments;
  int exit_code = 0;
  rprr::add_commands(app, arguments, exit_code);
  CLI11_PARSE(app, argc, argv);
  return exit_code;
}
