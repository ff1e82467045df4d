// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "commands.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/poses/methods.hpp"
#include "rprr_eval/report/text_table.hpp"
#include "rprr_eval/turntable/turntable.hpp"

namespace rprr {
namespace {

struct TurntableArguments {
  TurntableOptions options;
  std::vector<std::string> methods = {"icp", "icp_ivd", "icp_bd", "preview"};
  std::string json;
};

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

void write_json(const std::vector<TurntablePoint>& points,
                const std::vector<TurntableLimit>& limits, JsonOutput& out) {
  for (const TurntablePoint& p : points) {
    out.write({{"method", p.method},
               {"degrees", p.degrees},
               {"trials", p.trials},
               {"solved", p.solved},
               {"converged", p.converged},
               {"accepted", p.accepted},
               {"rms_m", p.rms_metres},
               {"rms_deg", p.rms_degrees},
               {"median_m", p.median_metres},
               {"median_deg", p.median_degrees},
               {"iterations_mean", p.mean_iterations},
               {"iterations_max", p.max_iterations}});
  }
  for (const TurntableLimit& limit : limits) {
    out.write({{"method", limit.method},
               {"first_miss_deg", or_null(limit.first_miss)},
               {"first_fails_deg", or_null(limit.first_fails)}});
  }
}

std::string table(const std::vector<TurntablePoint>& points,
                  const std::vector<TurntableLimit>& limits) {
  TextTable at_angles({"method", "deg", "solved", "accepted", "RMS deg", "RMS mm", "median deg",
                       "median mm", "iterations", "most"});
  for (const TurntablePoint& p : points) {
    const std::string of = " of " + std::to_string(p.trials);
    at_angles.add({p.method, fixed(p.degrees, 0), std::to_string(p.solved) + of,
                   std::to_string(p.accepted) + of, fixed(p.rms_degrees, 2),
                   fixed(1e3 * p.rms_metres, 1), fixed(p.median_degrees, 2),
                   fixed(1e3 * p.median_metres, 1), fixed(p.mean_iterations, 1),
                   std::to_string(p.max_iterations)});
  }
  TextTable ends({"method", "first miss at", "less than half solved from"});
  for (const TurntableLimit& limit : limits) {
    const auto angle = [](const std::optional<double>& degrees) {
      return degrees ? fixed(*degrees, 0) + " deg" : std::string("never");
    };
    ends.add({limit.method, angle(limit.first_miss), angle(limit.first_fails)});
  }
  return at_angles.text() + "\n" + ends.text();
}

int run(const TurntableArguments& arguments) {
  cv::setNumThreads(1);
  std::vector<std::string> notes;
  const Result<NamedRegistrations> made = make_methods(arguments.methods, notes);
  if (!made) return std::cerr << made.reason() << "\n", 1;
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  const auto points = run_turntable(arguments.options, *made);
  const auto limits = turntable_limits(points);
  write_json(points, limits, json);
  std::cerr << arguments.options.seeds << " tables, first seed " << arguments.options.first_seed
            << ", every method from the identity; solved: under 8 cm and 3 deg\n"
            << table(points, limits);
  return json.finish();
}

}  // namespace

void add_turntable_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<TurntableArguments>();
  CLI::App* command = app.add_subcommand(
      "turntable", "The paper's turntable, synthetic: error and iterations against the angle");
  TurntableOptions& options = arguments->options;
  command->add_option("--seeds", options.seeds, "number of tables, each with other objects")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--seed", options.first_seed,
                   "seed of the first table; the others count up from there")
      ->capture_default_str();
  command->add_option("--step", options.step_degrees, "step between angles, degrees")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--last", options.last_degrees, "largest angle, degrees")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--methods", arguments->methods, "methods by name; rprr_eval methods lists them")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
