// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "commands.hpp"
#include "open_folder.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/pairs/pair_runner.hpp"
#include "rprr_eval/pairs/pair_summary.hpp"

namespace rprr {
namespace {

struct PairsArguments {
  std::string folder;
  std::size_t step = 1;
  std::string profile = "default";
  std::string json;
  std::string pictures;
  int quality = -1;
  std::optional<std::size_t> a;
  std::optional<std::size_t> b;
};

std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const PairsArguments& arguments,
                                                          std::size_t entries) {
  if (arguments.a || arguments.b) {
    const std::size_t a = arguments.a.value_or(0);
    return {{a, arguments.b.value_or(a + arguments.step)}};
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t k = 0; k + arguments.step < entries; ++k) {
    pairs.emplace_back(k, k + arguments.step);
  }
  return pairs;
}

bool write_picture(const std::string& folder, std::size_t a, std::size_t b,
                   const PairResult& result) {
  const std::string path = folder + "/" + std::to_string(a) + "_" + std::to_string(b) + ".png";
  bool written = false;
  try {
    written = cv::imwrite(path, result.rebuilt.bgr);
  } catch (const cv::Exception&) {  // of what it cannot encode
  }
  if (!written) std::cerr << "\n" << path << ": cannot be written\n";
  return written;
}

int run_pairs(const PairsArguments& arguments) {
  cv::setNumThreads(1);  // figures are per core
  Result<Profile> profile = load_profile(arguments.profile);
  if (!profile) return std::cerr << profile.reason() << "\n", 1;
  if (arguments.quality >= 0) profile->codec.colour_quality = arguments.quality;
  const Result<TumFolder> folder = open_folder(arguments.folder);
  if (!folder) return std::cerr << folder.reason() << "\n", 1;
  Result<PairRunner> runner = PairRunner::create(*profile);
  if (!runner) return std::cerr << runner.reason() << "\n", 1;

  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  const auto pairs = pairs_of(arguments, folder->entries.size());
  if (pairs.empty()) {
    std::cerr << arguments.folder << " has " << folder->entries.size()
              << " entries: no pair is that far apart; use a smaller --step\n";
    return 1;
  }
  std::vector<PairResult> results;
  std::size_t left_out = 0;
  for (const auto& [a, b] : pairs) {
    Result<PairResult> result = runner->run(*folder, a, b);
    if (!result) {
      std::cerr << "\npair " << a << ", " << b << " left out: " << result.reason() << "\n";
      ++left_out;
      continue;
    }
    json.write(to_json(*result));
    if (!arguments.pictures.empty() && !write_picture(arguments.pictures, a, b, *result)) return 1;
    results.push_back(std::move(*result));
    results.back().rebuilt.bgr.release();  // a long run must not keep every picture
    results.back().rebuilt.depth.counts.release();
    results.back().rebuilt.provenance.release();
    results.back().exchange.at_dependent.frame.reset();
    results.back().exchange.at_reference.clear();
    std::cerr << "\rpair " << results.size() << " of " << pairs.size() << std::flush;
  }
  std::cerr << "\n";
  if (!results.empty()) std::cerr << summary_table(results, *profile);
  if (left_out > 0) {
    std::cerr << left_out << " of " << pairs.size() << " pairs left out, for the reasons above\n";
  }
  return json.finish(left_out > 0 ? 1 : 0);
}

}  // namespace

void add_pairs_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<PairsArguments>();
  CLI::App* command = app.add_subcommand(
      "pairs",
      "The whole scheme over pairs of a folder's frames: one JSON object a line, a summary "
      "on standard error");
  command->add_option("folder", arguments->folder, "TUM-layout folder")->required();
  command->add_option("--step", arguments->step, "pairs entry k with entry k+N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--profile", arguments->profile, "default, paper or a YAML file")
      ->capture_default_str();
  command->add_option("--a", arguments->a, "index of the entry that is the reference's frame");
  command->add_option("--b", arguments->b, "index of the entry that is the dependent's frame");
  command->add_option("--quality", arguments->quality,
                      "colour quality in the codec's own scale, instead of the profile's");
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->add_option("--pictures", arguments->pictures, "write rebuilt views into this folder")
      ->check(CLI::ExistingDirectory);
  command->callback([arguments, &exit_code] { exit_code = run_pairs(*arguments); });
}

}  // namespace rprr
