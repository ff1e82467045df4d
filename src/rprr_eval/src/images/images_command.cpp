// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "commands.hpp"
#include "rprr_eval/measure/metrics.hpp"

namespace rprr {
namespace {

// One line of the input: an image and the one that it should be.
int compare(const std::string& line) {
  std::istringstream words(line);
  std::string path, truth_path;
  if (!(words >> path >> truth_path)) {
    return std::cerr << "a line needs two files, not: " << line << "\n", 1;
  }
  const cv::Mat image = cv::imread(path, cv::IMREAD_COLOR);
  const cv::Mat truth = cv::imread(truth_path, cv::IMREAD_COLOR);
  if (image.empty() || truth.empty()) {
    return std::cerr << (image.empty() ? path : truth_path) << " is not an image\n", 1;
  }
  if (image.size() != truth.size()) {
    return std::cerr << path << " and " << truth_path << " differ in size\n", 1;
  }
  nlohmann::ordered_json out{{"image", path}, {"psnr", nullptr}, {"ssim", ssim(image, truth)}};
  if (const auto value = psnr(image, truth)) out["psnr"] = *value;
  std::cout << out << "\n";
  return 0;
}

int run() {
  cv::setNumThreads(1);
  std::string line;
  int failed = 0;
  while (std::getline(std::cin, line)) {
    if (!line.empty()) failed |= compare(line);
  }
  return failed;
}

}  // namespace

void add_images_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "images",
      "PSNR and SSIM of images against others: reads lines `IMAGE TRUTH` from standard input (no "
      "spaces in names), prints one JSON object a line");
  command->callback([&exit_code] { exit_code = run(); });
}

}  // namespace rprr
