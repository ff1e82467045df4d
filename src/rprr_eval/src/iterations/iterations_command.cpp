// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "commands.hpp"
#include "open_folder.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/exchange/exchange_registration.hpp"
#include "rprr_eval/iterations/exchange_survey.hpp"
#include "rprr_eval/profile/profile.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

struct IterationsArguments {
  std::string folder;
  std::string profile = "paper";
  std::vector<int> distances = {5, 10, 20, 30};
  std::string json;
};

nlohmann::json to_json(const std::string& folder, const std::string& profile, int distance,
                       const ExchangeSurvey& survey) {
  nlohmann::json histogram = nlohmann::json::object();
  for (const auto& [iterations, count] : survey.histogram) {
    histogram[std::to_string(iterations)] = count;
  }
  return {{"folder", folder},
          {"profile", profile},
          {"frames_apart", distance},
          {"pairs", survey.pairs},
          {"accepted", survey.accepted},
          {"rejected", survey.rejected},
          {"iterations_mean", survey.mean_iterations},
          {"iterations_max", survey.max_iterations},
          {"histogram", histogram},
          {"bytes_mean", survey.mean_bytes},
          {"bytes_median", survey.median_bytes},
          {"bytes_per_iteration", survey.bytes_per_iteration},
          {"messages_mean", survey.mean_messages}};
}

void add_row(TextTable& table, int distance, const ExchangeSurvey& survey) {
  table.add({std::to_string(distance), std::to_string(survey.pairs),
             std::to_string(survey.accepted), fixed(survey.mean_iterations, 1),
             std::to_string(survey.max_iterations), fixed(survey.median_bytes, 0),
             fixed(survey.bytes_per_iteration, 0), fixed(survey.mean_messages, 1)});
}

// Iterations, how often, and a bar.
std::string bars(const std::map<int, int>& histogram) {
  int most = 1;
  for (const auto& [iterations, count] : histogram) most = std::max(most, count);
  TextTable table({"iterations", "exchanges", ""});
  for (const auto& [iterations, count] : histogram) {
    table.add({std::to_string(iterations), std::to_string(count),
               std::string(static_cast<std::size_t>(1 + 39 * count / most), '#')});
  }
  return table.text();
}

Result<ExchangeSurvey> survey_distance(FrameSource& source, std::size_t step,
                                       const Profile& profile) {
  ExchangeSurveyor surveyor(make_exchange(profile, from_seconds(0.005)));
  for (std::size_t k = 0; k + step < source.folder().entries.size(); ++k) {
    const Result<RgbdFramePtr> a = source.frame(k);
    if (!a) return Error{a.reason()};
    const Result<RgbdFramePtr> b = source.frame(k + step);
    if (!b) return Error{b.reason()};
    surveyor.add(**a, **b);
  }
  return surveyor.survey();
}

int run(const IterationsArguments& arguments) {
  cv::setNumThreads(1);
  Result<Profile> profile = load_profile(arguments.profile);
  if (!profile) return std::cerr << profile.reason() << "\n", 1;
  profile->use_previews = false;  // which do not iterate over the radio
  const Result<TumFolder> folder = open_folder(arguments.folder);
  if (!folder) return std::cerr << folder.reason() << "\n", 1;
  const Distances distances = distances_of(*folder, arguments.distances);
  for (const auto& [frames, why] : distances.refused) {
    std::cerr << frames << " frames apart: " << why << "\n";
  }
  if (distances.allowed.empty()) return std::cerr << "no distance is possible here\n", 1;
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  FrameSource source(*folder, 64);
  TextTable table({"frames apart", "pairs", "accepted", "iterations", "most", "bytes (median)",
                   "bytes/iteration", "messages"});
  std::map<int, int> all;
  for (const auto& [frames, step] : distances.allowed) {
    const Result<ExchangeSurvey> survey = survey_distance(source, step, *profile);
    if (!survey) return std::cerr << survey.reason() << "\n", 1;
    json.write(to_json(arguments.folder, profile->name, frames, *survey));
    add_row(table, frames, *survey);
    for (const auto& [iterations, count] : survey->histogram) all[iterations] += count;
  }
  std::cerr << "profile " << profile->name << "; iterations, bytes and messages of accepted "
            << "exchanges, both ways\n"
            << table.text() << "\n"
            << bars(all);
  return json.finish();
}

}  // namespace

void add_iterations_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<IterationsArguments>();
  CLI::App* command = app.add_subcommand(
      "iterations", "How many iterations, bytes and messages the samples protocol needs");
  command->add_option("folder", arguments->folder, "TUM-layout folder")->required();
  command->add_option("--profile", arguments->profile, "default, paper or a YAML file")
      ->capture_default_str();
  command->add_option("--apart", arguments->distances, "original frames between a and b")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
