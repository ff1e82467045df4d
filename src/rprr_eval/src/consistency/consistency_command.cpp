// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <map>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "commands.hpp"
#include "report/json_output.hpp"
#include "report/verdict_json.hpp"
#include "rprr_eval/consistency/consistency.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

const std::map<std::string, TrueScene> kScenes = {{"room", TrueScene::kRoom},
                                                  {"turntable", TrueScene::kTurntable},
                                                  {"corridor", TrueScene::kCorridor}};

struct ConsistencyArguments {
  ConsistencyOptions options;
  std::string scene = "room";
  std::string profile = "default";
  std::string json;
};

constexpr std::array<const char*, 6> kAxes = {"tx", "ty", "tz", "rx", "ry", "rz"};

nlohmann::json to_json(const Twist& twist) {
  nlohmann::json out = nlohmann::json::object();
  for (int i = 0; i < 6; ++i) out[kAxes[static_cast<std::size_t>(i)]] = twist[i];
  return out;
}

nlohmann::json to_json(const PoseTrial& trial) {
  nlohmann::json out = {{"seed", trial.seed},
                        {"pair", trial.number},
                        {"overlap", trial.overlap},
                        {"true_deg", trial.true_degrees},
                        {"true_m", trial.true_metres},
                        {"accepted", trial.accepted()},
                        {"reason", trial.accepted() ? "" : describe(trial.verdict)},
                        {"verdict", to_json(trial.verdict)},
                        {"err_m", trial.error.metres},
                        {"err_deg", trial.error.degrees},
                        {"perturbation", to_json(trial.perturbation)}};
  if (trial.accepted()) {
    out["sigma"] = to_json(trial.covariance.diagonal().cwiseSqrt());
    out["normalised_error"] = normalised_error(trial);
  }
  return out;
}

nlohmann::json to_json(const NormalisedErrors& errors) {
  return {{"freedom", errors.freedom},
          {"mean", errors.mean},
          {"mean_from", errors.mean_from},
          {"mean_to", errors.mean_to},
          {"consistent", errors.consistent()},
          {"median", errors.median},
          {"share_within_95", errors.share_within_95},
          {"scale_by_mean", errors.scale_by_mean},
          {"scale_by_median", errors.scale_by_median}};
}

nlohmann::json to_json(const ConsistencySummary& summary) {
  return {{"pairs", summary.pairs},
          {"accepted", summary.accepted},
          {"accepted_right", summary.accepted_right},
          {"accepted_wrong", summary.accepted_wrong},
          {"median_m", summary.median_metres},
          {"median_deg", summary.median_degrees},
          {"p95_m", summary.p95_metres},
          {"p95_deg", summary.p95_degrees},
          {"all", to_json(summary.all)},
          {"translation", to_json(summary.translation)},
          {"rotation", to_json(summary.rotation)},
          {"mean_over_sigma", to_json(summary.mean)},
          {"rms_over_sigma", to_json(summary.rms)}};
}

std::string tables(const ConsistencySummary& summary) {
  TextTable accuracy({"pairs", "accepted", "right", "wrong", "median mm", "deg", "95% mm", "deg"});
  accuracy.add({std::to_string(summary.pairs), std::to_string(summary.accepted),
                std::to_string(summary.accepted_right), std::to_string(summary.accepted_wrong),
                fixed(1e3 * summary.median_metres, 1), fixed(summary.median_degrees, 2),
                fixed(1e3 * summary.p95_metres, 1), fixed(summary.p95_degrees, 2)});
  TextTable errors({"normalised error", "mean", "consistent", "within 95%", "median",
                    "scale by mean", "by median"});
  const auto row = [&](const char* name, const NormalisedErrors& e) {
    errors.add({name, fixed(e.mean, 2), fixed(e.mean_from, 2) + "-" + fixed(e.mean_to, 2),
                fixed(100.0 * e.share_within_95, 1) + "%", fixed(e.median, 2),
                fixed(e.scale_by_mean, 2), fixed(e.scale_by_median, 2)});
  };
  row("all six", summary.all);
  row("translation", summary.translation);
  row("rotation", summary.rotation);
  TextTable axes({"over its own sigma", "tx", "ty", "tz", "rx", "ry", "rz"});
  const auto axis_row = [&](const char* name, const Twist& values) {
    std::vector<std::string> cells{name};
    for (int i = 0; i < 6; ++i) cells.push_back(fixed(values[i], 2));
    axes.add(std::move(cells));
  };
  axis_row("mean", summary.mean);
  axis_row("RMS", summary.rms);
  return accuracy.text() + "\n" + errors.text() + "\n" + axes.text();
}

int run(const ConsistencyArguments& arguments) {
  cv::setNumThreads(1);
  const Result<Profile> profile = load_profile(arguments.profile);
  if (!profile) return std::cerr << profile.reason() << "\n", 1;
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  ConsistencyOptions options = arguments.options;
  options.scene = kScenes.at(arguments.scene);
  std::vector<PoseTrial> trials;
  for (int s = 0; s < options.seeds; ++s) {
    const std::uint32_t seed = options.first_seed + static_cast<std::uint32_t>(s);
    int number = 0;
    for (const TruePair& pair : consistency_pairs(seed, options)) {
      trials.push_back(try_pair(pair, *profile));
      trials.back().seed = seed;
      trials.back().number = number++;
      json.write(to_json(trials.back()));
    }
  }
  const ConsistencySummary summary = summarise(trials);
  json.write(to_json(summary));
  std::cerr << arguments.scene << " " << options.first_seed << " to "
            << options.first_seed + static_cast<std::uint32_t>(options.seeds) - 1
            << ", motions up to " << fixed(options.max_degrees, 0) << " deg and "
            << fixed(options.max_metres, 2) << " m, profile " << arguments.profile
            << ", robots that have not met; errors are of accepted poses\n"
            << tables(summary)
            << "consistent: 95% bounds of the mean if the covariances are right; within 95%: share "
               "of errors under the chi-square quantile;\nscale: what the covariances would have "
               "to be multiplied by; mean and RMS: of each component of log(M_est M_true^-1)\n";
  return json.finish();
}

void add_options(CLI::App* command, ConsistencyArguments& arguments) {
  ConsistencyOptions& options = arguments.options;
  command->add_option("--scene", arguments.scene, "what is rendered: room, turntable or corridor")
      ->check(CLI::IsMember(kScenes))
      ->capture_default_str();
  command->add_option("--seeds", options.seeds, "number of scenes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--first-seed", options.first_seed,
                   "seed of the first scene; the others count up from there")
      ->capture_default_str();
  command->add_option("--pairs", options.pairs_per_scene, "pairs of frames in each scene")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--max-degrees", options.max_degrees,
                   "largest turn between the frames of a pair, degrees")
      ->check(CLI::Range(0.0, 180.0))
      ->capture_default_str();
  command
      ->add_option("--max-metres", options.max_metres,
                   "largest distance between the frames of a pair, metres")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
  command
      ->add_option("--width", options.width, "width of the images, pixels; the height is 3/4 of it")
      ->check(CLI::Range(128, 1920))
      ->capture_default_str();
  command->add_option("--profile", arguments.profile, "default, paper, or a file")
      ->capture_default_str();
  command->add_option("--json", arguments.json, "write the JSON lines here");
}

}  // namespace

void add_consistency_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ConsistencyArguments>();
  CLI::App* command = app.add_subcommand(
      "consistency", "Errors of accepted poses against exact truth and against their covariances");
  add_options(command, *arguments);
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
