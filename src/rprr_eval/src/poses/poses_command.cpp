// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "commands.hpp"
#include "open_folder.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/measure/binomial.hpp"
#include "rprr_eval/measure/median.hpp"
#include "rprr_eval/poses/methods.hpp"
#include "rprr_eval/poses/pose_survey.hpp"
#include "rprr_eval/report/text_table.hpp"

namespace rprr {
namespace {

struct PosesArguments {
  std::string folder;
  std::size_t per_bin = 200;
  std::uint32_t seed = 1;
  std::size_t most_entries = 200;
  std::vector<std::string> methods;
  std::string json;
  std::string pairs_json;
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

void write_pair(const std::string& method, const PairRecord& record, JsonOutput& out) {
  const KnownPair& pair = record.pair;
  out.write({{"method", method},
             {"bin", kOverlapBins[overlap_bin(pair.overlap)].name},
             {"a", pair.a},
             {"b", pair.b},
             {"overlap", pair.overlap},
             {"true_deg", rotation_angle(pair.truth.linear()) * 180.0 / M_PI},
             {"true_m", pair.truth.translation().norm()},
             {"err_m", record.error.metres},
             {"err_deg", record.error.degrees},
             {"solved", record.solved},
             {"accepted", record.accepted},
             {"converged", record.converged},
             {"bytes", record.bytes},
             {"ms", record.ms}});
}

struct MethodRecords {
  std::string method;
  std::vector<PairRecord> records;  // of the same pairs in the same order for every method
};

Result<std::vector<PairRecord>> survey(FrameSource& source, const PickedPairs& picked,
                                       Registration& method) {
  std::vector<PairRecord> records;
  for (const std::vector<KnownPair>& bin : picked) {
    for (const KnownPair& pair : bin) {
      const Result<PairRecord> record = survey_pair(source, pair, method);
      if (!record) return Error{record.reason()};
      records.push_back(*record);
    }
  }
  return records;
}

std::string by_overlap(const std::vector<MethodRecords>& methods, JsonOutput& json) {
  TextTable table({"method", "overlap", "pairs", "solved", "accepted", "right", "wrong",
                   "wrong, 95% bound", "mm", "deg", "ms"});
  for (const auto& [method, records] : methods) {
    const auto add = [&, name = &method](const char* bin, const PoseTally& tally) {
      json.write(to_json(*name, bin, tally));
      add_row(table, *name, bin, tally);
    };
    for (std::size_t bin = 0; bin < kOverlapBins.size(); ++bin) {
      add(kOverlapBins[bin].name, tally_of(records, bin));
    }
    add("all", tally_of(records, std::nullopt));
  }
  return table.text();
}

std::string against_the_first(const std::vector<MethodRecords>& methods, JsonOutput& json) {
  const std::string& first = methods.front().method;
  TextTable table({first + " against", "both solve", "only " + first, "only other", "neither",
                   first + ", mm", "deg", "other, mm", "deg", "times slower"});
  for (std::size_t i = 1; i < methods.size(); ++i) {
    const HeadToHead duel = head_to_head(methods.front().records, methods[i].records);
    const auto error = [&](double value, int digits) {
      return duel.both > 0 ? fixed(value, digits) : std::string("-");
    };
    table.add({methods[i].method, std::to_string(duel.both), std::to_string(duel.only_first),
               std::to_string(duel.only_other), std::to_string(duel.neither),
               error(1e3 * duel.first.metres, 1), error(duel.first.degrees, 2),
               error(1e3 * duel.other.metres, 1), error(duel.other.degrees, 2),
               fixed(duel.times_slower, 1)});
    json.write({{"head_to_head", first},
                {"against", methods[i].method},
                {"both_solve", duel.both},
                {"only_first", duel.only_first},
                {"only_other", duel.only_other},
                {"neither", duel.neither},
                {"first_median_m", duel.first.metres},
                {"first_median_deg", duel.first.degrees},
                {"other_median_m", duel.other.metres},
                {"other_median_deg", duel.other.degrees},
                {"times_slower", duel.times_slower}});
  }
  return table.text();
}

void report(const std::vector<MethodRecords>& methods, JsonOutput& json) {
  std::cerr << "solved, right: under 8 cm and 3 deg; wrong: accepted, over 16 cm or 6 deg; bound: "
               "exact, one-sided, on the rate of wrong acceptances among all pairs;\n"
               "mm and deg: medians over solved pairs; ms: median of processor time\n"
            << by_overlap(methods, json);
  if (methods.size() < 2) return;
  std::cerr
      << "\nover all pairs; mm and deg: medians over pairs that both solve; times slower: the "
         "other's median time over the first's, both from nothing (rprr_eval timing: warm)\n"
      << against_the_first(methods, json);
}

int run(const PosesArguments& arguments) {
  cv::setNumThreads(1);
  std::vector<std::string> notes;
  const Result<NamedRegistrations> made = make_methods(arguments.methods, notes);
  if (!made) return std::cerr << made.reason() << "\n", 1;
  for (const std::string& note : notes) std::cerr << note << "\n";
  const Result<TumFolder> folder = open_folder(arguments.folder);
  if (!folder) return std::cerr << folder.reason() << "\n", 1;
  JsonOutput json(arguments.json);
  std::optional<JsonOutput> pairs_json;
  if (!arguments.pairs_json.empty()) pairs_json.emplace(arguments.pairs_json);
  if (!json.good() || (pairs_json && !pairs_json->good())) return 1;
  FrameSource source(*folder, arguments.most_entries);
  const Result<KnownPairs> known = known_pairs(source, arguments.most_entries);
  if (!known) return std::cerr << known.reason() << "\n", 1;
  const PickedPairs picked = pick_all(*known, arguments);
  std::vector<MethodRecords> all;
  for (const auto& method : *made) {
    const Result<std::vector<PairRecord>> records = survey(source, picked, *method);
    if (!records) return std::cerr << records.reason() << "\n", 1;
    all.push_back({method->name(), *records});
    for (std::size_t i = 0; pairs_json && i < records->size(); ++i) {
      write_pair(method->name(), (*records)[i], *pairs_json);
    }
    std::cerr << method->name() << " done\n";
  }
  report(all, json);
  return json.finish();
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
  command->add_option("--seed", arguments->seed, "seed of the random choice of pairs")
      ->capture_default_str();
  command
      ->add_option("--entries", arguments->most_entries,
                   "number of entries used of a long folder, spread evenly")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command
      ->add_option("--methods", arguments->methods,
                   "methods by name (default: all that are built in); rprr_eval methods lists them")
      ->delimiter(',');
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->add_option("--pairs-json", arguments->pairs_json,
                      "write a JSON line for every method and pair here");
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
