// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "commands.hpp"
#include "open_folder.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/measure/frame_source.hpp"
#include "rprr_eval/report/text_table.hpp"
#include "rprr_eval/timing/preview_timing.hpp"

namespace rprr {
namespace {

struct TimingArguments {
  std::vector<std::string> folders;
  std::size_t step = 1;
  std::size_t pairs = 40;
  std::string profile = "default";
  std::vector<std::string> peers = {"pcl_gicp", "pcl_plane"};
  WarmStart warm;
  std::string json;
};

// Pairs of a folder, or, without a name, of the synthetic room.
Result<std::vector<FramePair>> pairs_of(const std::string& folder_name,
                                        const TimingArguments& arguments) {
  if (folder_name.empty()) return synthetic_pairs(static_cast<int>(arguments.pairs), 1);
  const Result<TumFolder> folder = open_folder(folder_name);
  if (!folder) return Error{folder.reason()};
  FrameSource source(*folder);
  Result<std::vector<FramePair>> pairs = folder_pairs(source, arguments.step, arguments.pairs);
  if (pairs && pairs->empty()) return Error{folder_name + ": no pair is that far apart"};
  for (std::size_t i = 0; pairs && i < pairs->size(); ++i) {
    if ((*pairs)[i].first->bgr.empty()) return Error{folder_name + ": a preview needs colour"};
  }
  return pairs;
}

std::string times_slower(const TimeSpread& peer, const TimeSpread& ours) {
  return peer.pairs > 0 && ours.median > 0.0 ? fixed(peer.median / ours.median, 1) : "-";
}

void report(const std::string& data, const TimingSummary& summary, JsonOutput& json) {
  std::cerr << data << ": " << summary.pairs << " pairs, " << summary.accepted << " accepted, "
            << summary.warm_verified << " of their warm starts verified\n";
  TextTable table(
      {"processor time of this machine, ms", "pairs", "median", "95%", "times the preview"});
  const auto add = [&](const TimingRow& row, const TimeSpread* ours) {
    const std::string ratio = ours ? times_slower(row.time, *ours) : "";
    table.add({row.name, std::to_string(row.time.pairs), fixed(row.time.median, 2),
               fixed(row.time.p95, 2), ratio});
    nlohmann::json line = {{"data", data},
                           {"stage", row.name},
                           {"pairs", row.time.pairs},
                           {"median_ms", row.time.median},
                           {"p95_ms", row.time.p95}};
    if (ours && ours->median > 0.0) line["times_preview"] = row.time.median / ours->median;
    json.write(line);
  };
  for (const TimingRow* row : {&summary.make, &summary.encode, &summary.decode, &summary.prepare,
                               &summary.warm, &summary.cold}) {
    add(*row, nullptr);
  }
  add(summary.all_warm, nullptr);
  for (const TimingRow& row : summary.peers_warm) add(row, &summary.all_warm.time);
  add(summary.all_cold, nullptr);
  for (const TimingRow& row : summary.peers_cold) add(row, &summary.all_cold.time);
  std::cerr << table.text();
}

int run(const TimingArguments& arguments) {
  cv::setNumThreads(1);
  const Result<Profile> profile = load_profile(arguments.profile);
  if (!profile) return std::cerr << profile.reason() << "\n", 1;
  std::vector<std::string> notes;
  NamedRegistrations peers;
  if (!arguments.peers.empty()) {
    Result<NamedRegistrations> made = make_methods(arguments.peers, notes);
    if (!made) return std::cerr << made.reason() << "\n", 1;
    peers = std::move(*made);
  }
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  std::vector<std::string> folders = arguments.folders;
  if (folders.empty()) folders.emplace_back();
  for (const std::string& folder : folders) {
    const Result<std::vector<FramePair>> pairs = pairs_of(folder, arguments);
    if (!pairs) return std::cerr << pairs.reason() << "\n", 1;
    std::vector<PairTimes> times;
    for (const auto& [a, b] : *pairs) {
      const auto number = static_cast<std::uint32_t>(times.size());
      times.push_back(time_pair(*a, *b, *profile, peers, arguments.warm, number));
    }
    report(folder.empty() ? "synthetic" : folder, summarise(times, arguments.peers), json);
  }
  std::cerr << "one core; warm: from " << fixed(1e3 * arguments.warm.metres, 0) << " mm and "
            << fixed(arguments.warm.degrees, 1)
            << " deg off the accepted pose, peers from the same; cold: from nothing, peers from "
               "the identity\n";
  return json.finish();
}

void add_options(CLI::App* command, TimingArguments& arguments) {
  command->add_option("folders", arguments.folders,
                      "TUM-layout folders; without: two robots in the synthetic room");
  command->add_option("--step", arguments.step, "pairs entry k with entry k+N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--pairs", arguments.pairs, "number of pairs at most of each folder")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--profile", arguments.profile, "profile whose preview settings are used")
      ->capture_default_str();
  command->add_option("--peers", arguments.peers, "methods to compare with, by name")
      ->delimiter(',')
      ->capture_default_str();
  command->add_flag_callback(
      "--no-peers", [&arguments] { arguments.peers.clear(); }, "time the preview alone");
  command
      ->add_option("--warm-metres", arguments.warm.metres,
                   "metres by which warm starts are moved from the pose")
      ->capture_default_str();
  command
      ->add_option("--warm-degrees", arguments.warm.degrees,
                   "degrees by which warm starts are turned from the pose")
      ->capture_default_str();
  command->add_option("--json", arguments.json, "write the JSON lines here");
}

}  // namespace

void add_timing_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<TimingArguments>();
  CLI::App* command =
      app.add_subcommand("timing", "Processor time of the preview's stages beside PCL's methods");
  add_options(command, *arguments);
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
