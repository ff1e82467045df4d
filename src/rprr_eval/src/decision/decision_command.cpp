// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "commands.hpp"
#include "open_folder.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_redundancy/decision.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"
#include "rprr_view/view_synthesis.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

struct DecisionArguments {
  std::string folder;
  std::size_t step = 1;
  double off_metres = 0.01;  // how far the pose is off: about what an exchange reaches
  int preview_quality = 40;
  DecisionOptions options;
};

struct Tally {
  int blocks = 0, colour = 0, depth = 0, uncovered = 0, outside = 0, hidden = 0, recoloured = 0;
  int wrong_surface = 0, wrong_surface_sent = 0, right_surface_sent = 0;
  int wrong_colour = 0, wrong_colour_sent = 0, right_colour_sent_alone = 0;
  double ms = 0.0;
};

// Most of b's readings in the block are predicted elsewhere or not at all.
bool surface_is_wrong(const cv::Mat& predicted, const DepthFrame& b, const cv::Rect& rect) {
  int readings = 0;
  int wrong = 0;
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    for (int u = rect.x; u < rect.x + rect.width; ++u) {
      const double z = b.metres(u, v);
      if (z <= 0.0) continue;
      ++readings;
      const double off = std::abs(static_cast<double>(predicted.at<float>(v, u)) - z);
      wrong += off > same_surface_within(z) + 2.0 * depth_sigma(z) ? 1 : 0;
    }
  }
  return 4 * readings >= rect.area() && 2 * wrong > readings;
}

// The block's mean is off by more than 20 grey levels in a channel.
bool colour_is_wrong(const cv::Mat& predicted, const cv::Mat& b, const cv::Rect& rect) {
  const cv::Scalar off = cv::mean(predicted(rect)) - cv::mean(b(rect));
  return std::max({std::abs(off[0]), std::abs(off[1]), std::abs(off[2])}) > 20.0;
}

void judge(const BlockDecision& decision, const PredictedView& view, const RgbdImage& b,
           Tally& tally) {
  const BlockMaskPair& send = decision.send;
  const BlockGrid& grid = send.colour.grid();
  tally.blocks += grid.count();
  tally.colour += send.colour.count();
  tally.depth += send.depth.count();
  tally.uncovered += decision.uncovered;
  tally.outside += decision.outside;
  tally.hidden += decision.hidden;
  tally.recoloured += decision.recoloured;
  for (int block = 0; block < grid.count(); ++block) {
    const cv::Rect rect = grid.rect(block);
    const bool surface = surface_is_wrong(view.metres, b.depth, rect);
    const bool colour = colour_is_wrong(view.bgr, b.bgr, rect);
    tally.wrong_surface += surface ? 1 : 0;
    tally.wrong_surface_sent += surface && send.depth[block] ? 1 : 0;
    tally.right_surface_sent += !surface && send.depth[block] ? 1 : 0;
    tally.wrong_colour += colour ? 1 : 0;
    tally.wrong_colour_sent += colour && send.colour[block] ? 1 : 0;
    tally.right_colour_sent_alone += !colour && send.colour[block] && !send.depth[block] ? 1 : 0;
  }
}

std::string run_pair(const TumFolder& folder, std::size_t k, const DecisionArguments& arguments,
                     Decider& decider, Tally& tally) {
  const RgbdEntry& entry_a = folder.entries[k];
  const RgbdEntry& entry_b = folder.entries[k + arguments.step];
  if (!entry_a.world_from_camera || !entry_b.world_from_camera) return "no known poses";
  const Result<RgbdImage> a = folder.load(entry_a);
  const Result<RgbdImage> b = folder.load(entry_b);
  if (!a || !b) return a ? b.reason() : a.reason();
  Pose b_from_a = relative_pose_of(*entry_a.world_from_camera, *entry_b.world_from_camera);
  const double angle = 2.4 * static_cast<double>(k);  // another direction for every pair
  b_from_a.translation() +=
      arguments.off_metres * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  const Bytes bytes = encode_preview(make_preview(b->depth, b->bgr), arguments.preview_quality);
  const Result<BlockPreview> preview = decode_preview(bytes);
  if (!preview) return preview.reason();
  const auto start = std::chrono::steady_clock::now();
  const BlockDecision decision =
      decider.decide(a->depth, a->bgr, folder.camera, folder.camera, b_from_a, &*preview);
  tally.ms +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  ViewSynthesizer synthesizer;
  PredictedView view;
  synthesizer.synthesize(a->depth, a->bgr, folder.camera, folder.camera, b_from_a, view);
  judge(decision, view, *b, tally);
  return {};
}

int run(const DecisionArguments& arguments) {
  cv::setNumThreads(1);  // figures are per core
  const Result<TumFolder> folder = open_folder(arguments.folder);
  if (!folder) return std::cerr << folder.reason() << "\n", 1;
  Decider decider(arguments.options);
  Tally t;
  int pairs = 0;
  for (std::size_t k = 0; k + arguments.step < folder->entries.size(); ++k, ++pairs) {
    const std::string problem = run_pair(*folder, k, arguments, decider, t);
    if (!problem.empty()) return std::cerr << "pair " << k << ": " << problem << "\n", 1;
  }
  if (pairs == 0) return std::cerr << "no pair is that far apart; use a smaller --step\n", 1;
  const nlohmann::ordered_json out{{"pairs", pairs},
                                   {"blocks", t.blocks},
                                   {"sent", {{"colour", t.colour}, {"depth", t.depth}}},
                                   {"reasons",
                                    {{"uncovered", t.uncovered},
                                     {"outside", t.outside},
                                     {"hidden", t.hidden},
                                     {"recoloured", t.recoloured}}},
                                   {"surface",
                                    {{"wrong", t.wrong_surface},
                                     {"wrong_sent", t.wrong_surface_sent},
                                     {"right_sent", t.right_surface_sent}}},
                                   {"colour",
                                    {{"wrong", t.wrong_colour},
                                     {"wrong_sent", t.wrong_colour_sent},
                                     {"right_sent_alone", t.right_colour_sent_alone}}},
                                   {"ms", t.ms / pairs}};
  std::cout << out << std::endl;
  return 0;
}

}  // namespace

void add_decision_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<DecisionArguments>();
  CLI::App* command = app.add_subcommand(
      "decision",
      "How the decision's thresholds tell right blocks of the prediction from wrong ones: pairs of "
      "a folder with known poses, one JSON object");
  DecisionOptions& options = arguments->options;
  command->add_option("folder", arguments->folder, "TUM-layout folder with poses")->required();
  command->add_option("--step", arguments->step, "pairs entry k with entry k+N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--off", arguments->off_metres, "error given to the pose, metres")
      ->capture_default_str();
  command
      ->add_option("--preview-quality", arguments->preview_quality,
                   "quality of the preview's colours, 0 to 100")
      ->capture_default_str();
  command->add_option("--coverage", options.least_coverage, "least share covered")
      ->capture_default_str();
  command->add_option("--agreement", options.least_agreement, "least share at the preview's depth")
      ->capture_default_str();
  command
      ->add_option("--colour-tolerance", options.colour_tolerance,
                   "allowed difference of colours, grey levels")
      ->capture_default_str();
  command
      ->add_option("--colour-sigmas", options.colour_sigmas,
                   "allowed difference of colours, in sigmas of their robust spread")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace rprr
