// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "commands.hpp"
#include "json_output.hpp"
#include "rprr_eval/binomial.hpp"
#include "rprr_eval/methods.hpp"
#include "rprr_eval/pose_survey.hpp"
#include "rprr_eval/summary.hpp"
#include "rprr_eval/text_table.hpp"

namespace rprr {
namespace {

struct PosesArguments {
  std::string folder;
  std::size_t per_bin = 200;
  std::uint32_t seed = 1;
  std::size_t most_entries = 200;
  std::vector<std::string> methods;
  std::string json;
};

nlohmann::json to_json(const std::string& method, const std::string& bin, const PoseTally& tally) {
  nlohmann::json wrong_pairs = nlohmann::json::array();
  for (const KnownPair& pair : tally.wrong_pairs) wrong_pairs.push_back({pair.a, pair.b});
  return {{"method", method},
          {"overlap", bin},
          {"pairs", tally.pairs},
          {"solved", tally.solved},
          {"accepted", tally.accepted},
          {"accepted_right", tally.accepted_right},
          {"accepted_wrong", tally.accepted_wrong},
          {"wrong_pairs", wrong_pairs},
          {"wrong_rate_upper_95", clopper_pearson_upper(tally.accepted_wrong, tally.pairs)},
          {"median_m", median(tally.metres)},
          {"median_deg", median(tally.degrees)},
          {"median_ms", median(tally.ms)},
          {"median_bytes", median(tally.bytes)}};
}

void add_row(TextTable& table, const std::string& method, const std::string& bin,
             const PoseTally& tally) {
  table.add({method, bin, std::to_string(tally.pairs), std::to_string(tally.solved),
             std::to_string(tally.accepted), std::to_string(tally.accepted_right),
             std::to_string(tally.accepted_wrong),
             fixed(100.0 * clopper_pearson_upper(tally.accepted_wrong, tally.pairs), 2) + "%",
             tally.solved > 0 ? fixed(1e3 * median(tally.metres), 1) : "-",
             tally.solved > 0 ? fixed(median(tally.degrees), 2) : "-", fixed(median(tally.ms), 1)});
}

double median_motion_degrees(const std::vector<KnownPair>& pairs) {
  std::vector<double> degrees;
  for (const KnownPair& pair : pairs) {
    degrees.push_back(rotation_angle(pair.truth.linear()) * 180.0 / M_PI);
  }
  return median(degrees);
}

using PickedPairs = std::array<std::vector<KnownPair>, kOverlapBins.size()>;

PickedPairs pick_all(const KnownPairs& known, const PosesArguments& arguments) {
  PickedPairs picked;
  std::cerr << known.entries_used << " entries; ordered pairs by overlap:";
  for (std::size_t bin = 0; bin < picked.size(); ++bin) {
    picked[bin] = pick(known.bins[bin], arguments.per_bin,
                       arguments.seed * 16 + static_cast<std::uint32_t>(bin));
    std::cerr << "  " << kOverlapBins[bin].name << ": " << picked[bin].size() << " of "
              << known.bins[bin].size() << " (median "
              << fixed(median_motion_degrees(picked[bin]), 0) << " deg)";
  }
  std::cerr << "\n";
  return picked;
}

int run(const PosesArguments& arguments) {
  cv::setNumThreads(1);
  std::vector<std::string> notes;
  const Result<NamedRegistrations> made = make_methods(arguments.methods, notes);
  if (!made) return std::cerr << made.reason() << "\n", 1;
  for (const std::string& note : notes) std::cerr << note << "\n";
  const Result<TumFolder> folder = open_tum_folder(arguments.folder);
  if (!folder) return std::cerr << folder.reason() << "\n", 1;
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  FrameSource source(*folder, arguments.most_entries);
  const Result<KnownPairs> known = known_pairs(source, arguments.most_entries);
  if (!known) return std::cerr << known.reason() << "\n", 1;
  const PickedPairs picked = pick_all(*known, arguments);
  TextTable table({"method", "overlap", "pairs", "solved", "accepted", "right", "wrong",
                   "wrong, 95% bound", "mm", "deg", "ms"});
  for (const auto& method : *made) {
    PoseTally all;
    for (std::size_t bin = 0; bin < picked.size(); ++bin) {
      PoseTally tally;
      for (const KnownPair& pair : picked[bin]) {
        const Result<bool> done = survey_pair(source, pair, *method, tally);
        if (!done) return std::cerr << done.reason() << "\n", 1;
      }
      json.write(to_json(method->name(), kOverlapBins[bin].name, tally));
      add_row(table, method->name(), kOverlapBins[bin].name, tally);
      all += tally;
    }
    json.write(to_json(method->name(), "all", all));
    add_row(table, method->name(), "all", all);
    std::cerr << method->name() << " done\n";
  }
  std::cerr << "solved, right: under 8 cm and 3 deg; wrong: accepted, over 16 cm or 6 deg; bound: "
               "exact, one-sided, on the rate of wrong acceptances among all pairs;\n"
               "mm and deg: medians over solved pairs; ms: median of processor time\n"
            << table.text();
  return 0;
}

}  // namespace

void add_poses_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<PosesArguments>();
  CLI::App* command = app.add_subcommand(
      "poses",
      "Random pairs by overlap: which method finds the pose, and which vouches for wrong "
      "ones");
  command->add_option("folder", arguments->folder, "TUM-layout folder with true poses")->required();
  command->add_option("--per-bin", arguments->per_bin, "pairs for each range of overlaps")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "of the choice of pairs")->capture_default_str();
  command
      ->add_option("--entries", arguments->most_entries,
                   "of a long folder, so many entries, spread evenly")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command
      ->add_option("--methods", arguments->methods,
                   "by name (default: all that are built in); rprr_eval methods lists them")
      ->delimiter(',');
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

void add_methods_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("methods", "Lists the pose methods by name");
  command->callback([&exit_code] {
    TextTable table({"method", "", ""});
    for (const Method& method : methods()) {
      const auto made = method.make();
      table.add({method.name, method.description, made ? "" : made.reason()});
    }
    std::cout << table.text();
    exit_code = 0;
  });
}

}  // namespace rprr
