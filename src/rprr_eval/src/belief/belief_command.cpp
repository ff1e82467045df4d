// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <functional>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "commands.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/belief/belief.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

struct BeliefArguments {
  BeliefOptions options;
  std::uint32_t held_out_seed = 7001;
  std::string profile = "default";
  std::string json;
};

constexpr double kThresholds[] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};

using Judge = std::function<double(const PoseEvidence&)>;

void add_rows(TextTable& table, JsonOutput& json, const std::string& name, const Judge& judge,
              const std::vector<BeliefSample>& samples) {
  for (const double threshold : kThresholds) {
    int right = 0, wrong = 0, right_kept = 0, wrong_kept = 0;
    for (const BeliefSample& sample : samples) {
      const bool kept = judge(sample.evidence) >= threshold;
      ++(sample.right ? right : wrong);
      (sample.right ? right_kept : wrong_kept) += kept ? 1 : 0;
    }
    table.add({name, fixed(threshold, 0),
               std::to_string(right_kept) + " of " + std::to_string(right),
               std::to_string(wrong_kept) + " of " + std::to_string(wrong)});
    json.write({{"model", name},
                {"threshold", threshold},
                {"right", right},
                {"right_accepted", right_kept},
                {"wrong", wrong},
                {"wrong_accepted", wrong_kept}});
  }
}

void show(const BeliefModel& model, const std::vector<BeliefSample>& samples) {
  static constexpr const char* kNames[] = {"correlation", "fine correlation", "outlier share",
                                           "free space", "margin"};
  const std::array<double, kEvidenceTerms> typical = typical_terms(samples);
  TextTable table({"term", "slope", "median of right poses"});
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    table.add({kNames[i], fixed(model.slopes[i], 2), fixed(typical[i], 2)});
  }
  table.add({"constant", fixed(model.constant, 2), ""});
  std::cerr << "fitted anew, from " << samples.size() << " samples:\n" << table.text();
}

int run(const BeliefArguments& arguments) {
  cv::setNumThreads(1);
  const Result<Profile> profile = load_profile(arguments.profile);
  if (!profile) return std::cerr << profile.reason() << "\n", 1;
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  std::cerr << "rendering and searching " << arguments.options.scenes << " scenes to fit on\n";
  const std::vector<BeliefSample> samples = belief_samples(arguments.options, *profile);
  BeliefOptions held_out = arguments.options;
  held_out.first_seed = arguments.held_out_seed;
  std::cerr << "rendering and searching " << held_out.scenes << " other scenes to try the fit on\n";
  const std::vector<BeliefSample> others = belief_samples(held_out, *profile);
  const BeliefModel model = fit_belief(samples);
  show(model, samples);
  TextTable table({"model", "log odds at least", "right accepted", "wrong accepted"});
  add_rows(
      table, json, "built in", [](const PoseEvidence& e) { return log_odds(e); }, others);
  add_rows(
      table, json, "fitted anew", [&](const PoseEvidence& e) { return model.log_odds(e); }, others);
  std::cerr << "on the scenes that were held out:\n" << table.text();
  return json.finish();
}

}  // namespace

void add_belief_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BeliefArguments>();
  CLI::App* command = app.add_subcommand(
      "belief",
      "Fits the log odds that a pose from a preview is right, and tries them on other scenes");
  BeliefOptions& options = arguments->options;
  command
      ->add_option(
          "--scenes", options.scenes,
          "number of synthetic scenes to fit on; as many others are rendered to try the fit")
      ->check(CLI::Range(3, 10000))
      ->capture_default_str();
  command->add_option("--pairs", options.pairs_per_scene, "pairs of frames rendered in each scene")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--first-seed", options.first_seed,
                   "seed of the first scene to fit on; the others count up from there")
      ->capture_default_str();
  command
      ->add_option("--held-out-seed", arguments->held_out_seed,
                   "seed of the first scene to try the fit on")
      ->capture_default_str();
  command->add_option("--profile", arguments->profile, "default, or the path of a profile")
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
