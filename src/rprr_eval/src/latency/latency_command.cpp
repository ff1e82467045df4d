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

struct LatencyArguments {
  std::string folder;
  std::size_t step = 1;
  std::size_t pairs = 50;
  std::vector<double> round_trips = {5.0, 20.0, 100.0};
  std::string json;
};

// A protocol with its settings; a new one is one line in protocols().
struct Protocol {
  std::string name;
  Profile profile;
};

Result<std::vector<Protocol>> protocols() {
  const Result<Profile> ours = load_profile("default");
  if (!ours) return Error{ours.reason()};
  const Result<Profile> paper = load_profile("paper");
  if (!paper) return Error{paper.reason()};
  Profile samples = *ours;
  samples.use_previews = false;
  return std::vector<Protocol>{{"preview", *ours},
                               {"samples, profile default", samples},
                               {"samples, profile paper", *paper}};
}

Result<std::vector<FramePair>> pairs_of(const LatencyArguments& arguments) {
  if (arguments.folder.empty()) return synthetic_pairs(static_cast<int>(arguments.pairs), 1);
  const Result<TumFolder> folder = open_folder(arguments.folder);
  if (!folder) return Error{folder.reason()};
  FrameSource source(*folder);
  Result<std::vector<FramePair>> pairs = folder_pairs(source, arguments.step, arguments.pairs);
  if (pairs && pairs->empty()) return Error{arguments.folder + ": no pair is that far apart"};
  return pairs;
}

int run(const LatencyArguments& arguments) {
  cv::setNumThreads(1);
  const Result<std::vector<Protocol>> all = protocols();
  if (!all) return std::cerr << all.reason() << "\n", 1;
  const Result<std::vector<FramePair>> pairs = pairs_of(arguments);
  if (!pairs) return std::cerr << pairs.reason() << "\n", 1;
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  TextTable table(
      {"protocol", "round trip", "accepted", "decided after", "if accepted", "processor time"});
  for (const Protocol& protocol : *all) {
    for (const double round_trip : arguments.round_trips) {
      ExchangeSurveyor surveyor(make_exchange(protocol.profile, from_seconds(round_trip / 2e3)));
      for (const auto& [a, b] : *pairs) surveyor.add(*a, *b);
      const ExchangeSurvey survey = surveyor.survey();
      json.write({{"protocol", protocol.name},
                  {"round_trip_ms", round_trip},
                  {"pairs", survey.pairs},
                  {"accepted", survey.accepted},
                  {"median_ms", survey.median_latency_ms},
                  {"median_accepted_ms", survey.median_accepted_latency_ms},
                  {"median_compute_ms", survey.median_compute_ms}});
      table.add({protocol.name, fixed(round_trip, 0) + " ms",
                 std::to_string(survey.accepted) + " of " + std::to_string(survey.pairs),
                 fixed(survey.median_latency_ms, 0) + " ms",
                 fixed(survey.median_accepted_latency_ms, 0) + " ms",
                 fixed(survey.median_compute_ms, 1) + " ms"});
    }
  }
  std::cerr << "medians of the time from the frames to b's decision on the simulated channel; the "
               "processor "
               "time of both robots on this machine comes on top\n"
            << table.text();
  return json.finish();
}

}  // namespace

void add_latency_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<LatencyArguments>();
  CLI::App* command = app.add_subcommand(
      "latency", "Time from frame to decision at given round trips, simulated channel");
  command->add_option("folder", arguments->folder,
                      "TUM-layout folder; without: two robots in the synthetic room");
  command->add_option("--step", arguments->step, "pairs entry k with entry k+N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--pairs", arguments->pairs, "number of pairs at most")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--round-trips", arguments->round_trips,
                   "round trips of the simulated channel to try, milliseconds")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
