// SPDX-License-Identifier: BSD-3-Clause
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <opencv2/core.hpp>

#include "commands.hpp"
#include "open_folder.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/measure/median.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_pose/preview_protocol.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

struct PreviewArguments {
  std::vector<std::string> folders;
  double step = PreviewOptions().step;
  int quality = PreviewOptions().colour_quality;
  bool lossless = false;
  int repeats = 5;
  std::string json;
};

// One value a frame.
struct Figures {
  std::vector<double> valid, bytes, depth, colour, psnr, make_ms, encode_ms, decode_ms;
};

// Processor time of this thread, so that a busy machine does not count.
double now_ms() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double median_ms(int repeats, const std::function<void()>& action) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const double start = now_ms();
    action();
    times.push_back(now_ms() - start);
  }
  return median(times);
}

/// The error, if there is one.
std::string measure(const RgbdImage& image, const PreviewArguments& arguments, Figures& figures) {
  BlockPreview preview;
  Bytes bytes;
  Result<BlockPreview> back = Error{"not decoded"};
  figures.make_ms.push_back(median_ms(arguments.repeats, [&] {
    preview = arguments.lossless ? make_exact_preview(image.depth, image.bgr)
                                 : make_preview(image.depth, image.bgr, arguments.step);
  }));
  figures.encode_ms.push_back(
      median_ms(arguments.repeats, [&] { bytes = encode_preview(preview, arguments.quality); }));
  figures.decode_ms.push_back(median_ms(arguments.repeats, [&] { back = decode_preview(bytes); }));
  if (!back) return back.reason();
  if (cv::norm(back->depth, preview.depth, cv::NORM_INF) != 0.0) return "depths did not come back";
  const auto depth = static_cast<double>(preview_depth_bytes(bytes));
  const auto colour = static_cast<double>(preview_colour_bytes(bytes));
  figures.valid.push_back(cv::countNonZero(preview.depth));
  figures.bytes.push_back(static_cast<double>(bytes.size()));
  figures.depth.push_back(depth);
  figures.colour.push_back(colour);
  figures.psnr.push_back(*psnr(back->bgr, preview.bgr));
  return {};
}

nlohmann::ordered_json line_of(const std::string& folder, const PreviewArguments& arguments,
                               const Figures& figures) {
  nlohmann::ordered_json line{{"folder", folder},
                              {"frames", figures.bytes.size()},
                              {"quality", arguments.quality},
                              {"lossless", arguments.lossless}};
  if (!arguments.lossless) line["step"] = arguments.step;
  line["blocks_with_depth"] = median(figures.valid);
  line["bytes"] = {{"depth", median(figures.depth)},
                   {"colour", median(figures.colour)},
                   {"total", median(figures.bytes)}};
  line["psnr"] = median(figures.psnr);
  line["ms"] = {{"make", median(figures.make_ms)},
                {"encode", median(figures.encode_ms)},
                {"decode", median(figures.decode_ms)}};
  return line;
}

int run(const PreviewArguments& arguments) {
  cv::setNumThreads(1);  // figures are per core
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  for (const std::string& path : arguments.folders) {
    const Result<TumFolder> folder = open_folder(path);
    if (!folder) return std::cerr << folder.reason() << "\n", 1;
    Figures figures;
    for (const RgbdEntry& entry : folder->entries) {
      const Result<RgbdImage> image = folder->load(entry);
      if (!image) return std::cerr << image.reason() << "\n", 1;
      const std::string problem = measure(*image, arguments, figures);
      if (!problem.empty()) return std::cerr << entry.depth_path << ": " << problem << "\n", 1;
    }
    const std::string name = fs::path(path + "/").parent_path().filename().string();
    json.write(line_of(name, arguments, figures));
  }
  return json.finish();
}

}  // namespace

void add_preview_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<PreviewArguments>();
  CLI::App* command = app.add_subcommand(
      "preview",
      "Block previews of all frames of folders: medians of bytes, PSNR of the colours against the "
      "blocks' means, milliseconds of processor time; one JSON object a line");
  command->add_option("folder", arguments->folders, "TUM-layout folders")->required();
  command->add_option("--step", arguments->step, "step to which inverse depth is rounded, 1/metre")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--quality", arguments->quality,
                   "quality of the colours, 0 to 100 as WebP counts it")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  command->add_flag("--lossless", arguments->lossless, "depth as unchanged readings, not in steps");
  command->add_option("--repeats", arguments->repeats, "runs of each frame; their median counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
