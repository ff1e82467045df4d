// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "commands.hpp"
#include "open_folder.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/curves/curve_comparison.hpp"

namespace rprr {
namespace {

struct CurvesArguments {
  std::vector<std::string> folders;
  std::vector<std::string> from;
  std::vector<std::size_t> steps = {1};
  std::string profile = "default";
  std::string json;
  std::string pairs_json;
  std::string markdown;
  std::string sheets;
  std::size_t every = 1;
  int points = 16;
};

struct PairNumbers {
  std::size_t a, b;
};

// By b, so that b's whole frame is coded once for all steps.
std::vector<PairNumbers> pairs_of(const CurvesArguments& arguments, std::size_t entries) {
  std::vector<PairNumbers> pairs;
  for (const std::size_t step : arguments.steps) {
    for (std::size_t k = 0; k + step < entries; k += arguments.every) {
      pairs.push_back({k, k + step});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const PairNumbers& one, const PairNumbers& other) {
    return one.b != other.b ? one.b < other.b : one.a > other.a;
  });
  return pairs;
}

// Everything that one run needs beside the folder.
class CurvesRun {
 public:
  CurvesRun(CurvesArguments arguments, Profile ours, Profile paper)
      : arguments_(std::move(arguments)),
        ours_(std::move(ours)),
        paper_(std::move(paper)),
        json_(arguments_.json),
        whole_({{ours_.codec.colour_codec, ours_.codec.colour_quality},
                {paper_.codec.colour_codec, paper_.codec.colour_quality}},
               ours_.codec.depth_mode) {
    if (!arguments_.pairs_json.empty()) {
      pairs_json_ = std::make_unique<JsonOutput>(arguments_.pairs_json);
    }
  }

  // Empty, or what went wrong.
  std::string run() {
    if (!json_.good() || (pairs_json_ && !pairs_json_->good())) return "no output";
    std::vector<std::vector<PairCurves>> folders;
    for (const std::string& path : arguments_.folders) {
      const Result<TumFolder> folder = open_folder(path);
      if (!folder) return folder.reason();
      const std::string name = std::filesystem::path(path + "/").parent_path().filename().string();
      const std::string wrong = measure(*folder, name, folders.emplace_back());
      if (!wrong.empty()) return wrong;
      report(name, folders.back());
    }
    for (const std::string& path : arguments_.from) {
      const std::string wrong = read(path, folders);
      if (!wrong.empty()) return wrong;
    }
    if (!arguments_.from.empty()) {
      for (const auto& pairs : folders) report(pairs.front().folder, pairs);
    }
    report_together(folders);
    return finish();
  }

 private:
  std::string measure(const TumFolder& folder, const std::string& name,
                      std::vector<PairCurves>& found) {
    const auto pairs = pairs_of(arguments_, folder.entries.size());
    if (pairs.empty()) return name + " has no pair that is so far apart; use a smaller --step";
    std::map<std::size_t, CurveMeasurer> by_step;
    for (const PairNumbers& pair : pairs) {
      const std::size_t step = pair.b - pair.a;
      if (by_step.count(step) == 0) {
        Result<CurveMeasurer> made = CurveMeasurer::create(ours_, paper_, arguments_.points);
        if (!made) return made.reason();
        by_step.emplace(step, std::move(*made));
      }
      Result<PairCurves> curves = by_step.at(step).measure(folder, name, pair.a, pair.b, whole_);
      if (!curves)
        return "pair " + std::to_string(pair.a) + ", " + std::to_string(pair.b) + ": " +
               curves.reason();
      if (pairs_json_) pairs_json_->write(to_json(*curves));
      const bool middle = found.size() == pairs.size() / 2;
      if (middle && !arguments_.sheets.empty() && !write_sheet(folder, *curves)) {
        return "cannot write into " + arguments_.sheets;
      }
      drop_pictures(*curves);
      found.push_back(std::move(*curves));
      std::cerr << "\r" << name << ": pair " << found.size() << " of " << pairs.size()
                << std::flush;
    }
    std::cerr << "\n";
    return {};
  }

  // What an earlier run wrote with --pairs-json; empty, or what went wrong.
  static std::string read(const std::string& path, std::vector<std::vector<PairCurves>>& folders) {
    std::ifstream file(path);
    if (!file) return "cannot read " + path;
    for (std::string line; std::getline(file, line);) {
      Result<PairCurves> pair =
          pair_curves_of(nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false));
      if (!pair) return path + ": " + pair.reason();
      const auto same = [&](const auto& pairs) { return pairs.front().folder == pair->folder; };
      auto pairs = std::find_if(folders.begin(), folders.end(), same);
      if (pairs == folders.end()) pairs = folders.emplace(folders.end());
      pairs->push_back(std::move(*pair));
    }
    return {};
  }

  // Those with ground truth, if there are several.
  void report_together(const std::vector<std::vector<PairCurves>>& folders) {
    std::string name;
    std::vector<PairCurves> all;
    int count = 0;
    for (const auto& pairs : folders) {
      if (!pairs.front().overlap) continue;
      name += (count++ > 0 ? " + " : "") + pairs.front().folder;
      all.insert(all.end(), pairs.begin(), pairs.end());
    }
    if (count > 1) report(name, all);
  }

  // Of the pair in the middle of the folder.
  bool write_sheet(const TumFolder& folder, const PairCurves& pair) const {
    const Result<RgbdImage> truth = folder.load(pair.b);
    return truth && cv::imwrite(arguments_.sheets + "/" + pair.folder + ".png",
                                curve_sheet(pair, truth->bgr, ours_.codec.colour_codec));
  }

  // A long run must not keep every picture.
  static void drop_pictures(PairCurves& pair) {
    pair.new_content.release();
    for (MethodCurve& method : pair.methods) {
      for (RatePoint& point : method.points) point.bgr.release();
      if (method.at_profile) method.at_profile->bgr.release();
    }
  }

  void report(const std::string& name, const std::vector<PairCurves>& pairs) {
    nlohmann::json comparison = compare_curves(pairs, ours_.codec.colour_codec);
    comparison["folder"] = name;
    std::set<std::size_t> steps;
    for (const PairCurves& pair : pairs) steps.insert(pair.step);
    comparison["steps"] = steps;
    comparison["profile"] = ours_.name;
    comparison["colour_codec"] = ours_.codec.colour_codec;
    comparison["colour_quality"] = ours_.codec.colour_quality;
    comparison["sparse_colours"] = text_of(ours_.codec.sparse_colours);
    comparison["paper_quality"] = paper_.codec.colour_quality;
    json_.write(comparison);
    comparisons_.push_back(comparison);
    std::cerr << "\n" << name << ": " << comparison_text(comparison) << "\n";
  }

  // Puts all files in their places. Empty, or what went wrong.
  std::string finish() {
    if (json_.finish() != 0 || (pairs_json_ && pairs_json_->finish() != 0)) return "no output";
    ResultFile markdown(arguments_.markdown);
    markdown.stream() << comparison_markdown(comparisons_);
    markdown.finish();
    return markdown.problem();
  }

  CurvesArguments arguments_;
  Profile ours_, paper_;
  JsonOutput json_;
  std::unique_ptr<JsonOutput> pairs_json_;
  WholeFrames whole_;
  std::vector<nlohmann::json> comparisons_;
};

int run_curves(const CurvesArguments& arguments) {
  if (arguments.folders.empty() && arguments.from.empty()) {
    return std::cerr << "name a folder, or give --from\n", 1;
  }
  cv::setNumThreads(1);  // figures are per core
  const Result<Profile> ours = load_profile(arguments.profile);
  if (!ours) return std::cerr << ours.reason() << "\n", 1;
  const Result<Profile> paper = load_profile("paper");
  if (!paper) return std::cerr << paper.reason() << "\n", 1;
  const std::string wrong = CurvesRun(arguments, *ours, *paper).run();
  if (!wrong.empty()) return std::cerr << "\n" << wrong << "\n", 1;
  return 0;
}

}  // namespace

void add_curves_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CurvesArguments>();
  CLI::App* command = app.add_subcommand(
      "curves",
      "The picture per byte: every pair through our profile with objectives view and map, the "
      "profile paper, and independent coding by PGF, JPEG, WebP and JPEG XL, each over its whole "
      "range of bytes. One JSON object a folder, and one for all with ground truth together; "
      "tables on standard "
      "error");
  auto* folders = command->add_option("folder", arguments->folders, "TUM-layout folders");
  command
      ->add_option("--from", arguments->from,
                   "instead of folders: compare anew what --pairs-json wrote earlier")
      ->excludes(folders)
      ->check(CLI::ExistingFile);
  command
      ->add_option("--step", arguments->steps, "pairs entry k with entry k+N; several may be given")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--profile", arguments->profile, "profile of RPRR: default or a YAML file")
      ->capture_default_str();
  command
      ->add_option("--every", arguments->every, "only pairs whose a is the K-th, 2K-th, ... entry")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--points", arguments->points, "number of byte budgets tried for each objective")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->add_option("--pairs-json", arguments->pairs_json,
                      "write every point of every pair here, one JSON object a pair");
  command->add_option("--markdown", arguments->markdown, "write tables for people here");
  command
      ->add_option("--sheet", arguments->sheets,
                   "write a contact sheet of each folder's middle pair at equal bytes into this "
                   "folder")
      ->check(CLI::ExistingDirectory);
  command->callback([arguments, &exit_code] { exit_code = run_curves(*arguments); });
}

}  // namespace rprr
