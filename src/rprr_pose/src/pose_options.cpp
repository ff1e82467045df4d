// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_options.hpp"

#include <algorithm>

namespace rprr {
namespace {

constexpr OptionRange kShare = {0.0, 1.0};
constexpr OptionRange kTimeout = {0.01, 60.0};  // [s]

void list_preview(PreviewOptions& o, OptionTable& table) {
  PreviewLimits& limits = o.search.limits;
  StartRange& range = o.search.range;
  table.group(
      "Protocol preview: the dependent sends one small message, the reference finds the pose");
  table.number("preview_step", o.step, {0.0005, 0.05}, "1/m",
               "Step of inverse depth that a preview is rounded to; a Kinect's own is 0.00285");
  table.flag("preview_lossless", o.lossless_depth,
             "Send one unchanged reading of the sensor for each block, whatever its step");
  table.whole("preview_quality", o.colour_quality, {0, 100}, "",
              "Quality of a preview's colours, WebP's scale");
  table.number("search_yaw", range.yaw, {0.0, 180.0}, "degrees",
               "How far a search's starting rotations turn, either way, about the vertical");
  table.number("search_pitch", range.pitch, {0.0, 90.0}, "degrees",
               "How far a search's starting rotations nod, either way");
  table.number("search_roll", range.roll, {0.0, 180.0}, "degrees",
               "How far a search's starting rotations tilt, either way");
  table.number("preview_min_overlap", limits.min_overlap, kShare, "",
               "A pose is accepted if this share of either preview falls into the other");
  table.number("preview_max_violating", limits.max_violating, kShare, "",
               "A pose is accepted if no more than this share of what both see lies in free space");
  table.number("preview_min_evidence", limits.min_evidence, {-20.0, 20.0}, "log odds",
               "A pose is accepted if it is right with these odds: docs/pose.md");
  table.number("preview_min_margin", limits.min_margin, kShare, "",
               "A pose is accepted if its score is so much above that of the best other pose");
  table.number("preview_warm_evidence", limits.warm_evidence, {0.0, 20.0}, "log odds",
               "What a pose needs beyond preview_min_evidence if it was found without a search");
  table.number(
      "preview_max_sigma_translation", limits.max_sigma_translation, {0.0001, 1.0}, "m",
      "Standard deviation in the worst direction; beyond it that direction counts as free");
  table.number("preview_max_sigma_rotation", limits.max_sigma_rotation, {0.0001, 1.0}, "rad",
               "Standard deviation about the worst axis; beyond it that axis counts as free");
  table.seconds(
      "reference_age", o.reference_age, {0.0, 3600.0},
      "While its radio is busy a reference refers to a frame that it sent at most so long "
      "ago, and where no frame is near the dependent's in time to the nearest one; 0 does "
      "neither. For scenes that stand still");
}

void list_samples(SamplesOptions& o, OptionTable& table) {
  VerificationLimits& limits = o.limits;
  table.group("Protocol samples: points and halves of the normal equations go to and fro");
  table.whole("sample_count", o.sample_count, {10, 1000}, "points", "Points that a robot sends");
  table.whole("max_iterations", o.max_iterations, {1, 250}, "",
              "After so many iterations a pose is rejected");
  table.number("converged_translation", o.converged_translation, {1e-6, 0.1}, "m",
               "A smaller step ends the iteration");
  table.number("converged_rotation", o.converged_rotation, {1e-6, 0.1}, "rad",
               "A smaller step ends the iteration");
  table.flag("resample", o.resample,
             "Take new points in every iteration, as in the paper, instead of one set");
  table.flag("weigh_by_noise", o.by_noise,
             "Weights also follow the sensor's noise, and outliers are left out");
  table.flag("local_start", o.local_start,
             "Align the dependent's points to the reference's depth alone before the iteration");
  table.number("min_overlap", limits.min_overlap, kShare, "",
               "Share of the points that must fall into the other's view");
  table.number("min_consistent", limits.min_consistent, kShare, "",
               "Share of the points in view whose depths must agree within noise");
  table.number("max_violating", limits.max_violating, kShare, "",
               "Share of the points in view that may lie in seen free space");
  table.number("max_residual_sigmas", limits.max_residual_sigmas, {0.1, 1000.0}, "",
               "RMS residual, in units of what the sensor's noise makes");
  table.whole("min_matched", limits.min_matched, {6, 2000}, "points",
              "Correspondences that a pose needs, both ways together");
  table.number(
      "max_sigma_translation", limits.max_sigma_translation, {0.0001, 1.0}, "m",
      "Standard deviation in the worst direction; beyond it that direction counts as free");
  table.number("max_sigma_rotation", limits.max_sigma_rotation, {0.0001, 1.0}, "rad",
               "Standard deviation about the worst axis; beyond it that axis counts as free");
  table.seconds("silence_timeout", o.silence_timeout, kTimeout,
                "A frame of the dependent that no reference asks for goes out whole after this");
}

bool is_frame(const OptionValue& value) {
  return !std::get<std::string>(value).empty();
}

}  // namespace

void list_options(ExchangeOptions& o, OptionTable& table) {
  table.group("Exchanges");
  table.word<bool>("protocol", o.use_previews, {{"preview", true}, {"samples", false}},
                   "How poses are found; samples is the paper's. All robots need the same");
  table.seconds("step_timeout", {&o.preview.step_timeout, &o.samples.step_timeout}, kTimeout,
                "How long a robot waits for its peer's answer");
  table.seconds("min_period", {&o.preview.min_period, &o.samples.min_period}, {0.0, 3600.0},
                "Least time between the starts of exchanges. Protocol preview: at the dependent; "
                "samples: at the reference");
  table.seconds("max_frame_difference",
                {&o.preview.max_stamp_difference, &o.samples.max_stamp_difference}, {0.0, 60.0},
                "How far apart the stamps of two robots' frames may be. Protocol preview: at the "
                "reference; samples: at the dependent");
  list_preview(o.preview, table);
  list_samples(o.samples, table);
}

void list_options(ExchangeNodeOptions& o, OptionTable& table) {
  table.group("The robot");
  table.robot("robot", o.robot, "This robot; its topics are in /ROBOT").as_wiring();
  table.texts("peers", o.peers, "Robots that this one may exchange with")
      .as_wiring()
      .only_if(are_robot_names, kRobotNamesRule);
  table
      .texts("references", o.references,
             "Those of the peers whose frames this robot refers to from the start; the service "
             "~set_reference changes it")
      .as_wiring()
      .only_if(are_robot_names, kRobotNamesRule);
  table.flag("link_recovery", o.link_recovery,
             "Make subscriptions to peers anew when their host answers again after a silence; "
             "false: left to TCP, which may take as long again as the silence was");
  table.group("Poses in tf, published and used");
  table.number("stale_overlap", o.stale_overlap, kShare, "",
               "If the newest frame at an exchange's end shares less than this with the exchange's "
               "frame, /diagnostics calls the pose stale");
  table.flag("publish_tf", o.publish_tf, "Accepted poses go to /tf");
  table.word<TfTarget>("tf_target", o.tf_target,
                       {{"own", TfTarget::kOwn}, {"root", TfTarget::kRoot}},
                       "What hangs below the reference's optical frame: own, "
                       "<dependent>_rprr_optical_frame; root, the root of the dependent's tf tree");
  table.flag("tf_prior", o.tf_prior,
             "Try what tf knows of a pose before the search: the pose through a tree in which both "
             "cameras hang, and the last accepted pose carried on by odometry. Where /tf crosses "
             "the radio, weigh its cost: a tree at 50 Hz outweighs all of RPRR");
  table
      .text("tf_prior_fixed_frame", o.tf_prior_fixed_frame,
            "Frame above both cameras, such as map; auto: the root of their common tree")
      .only_if(is_frame, "auto or a frame");
  table
      .text("tf_prior_odom_frame", o.tf_prior_odom_frame,
            "Frame above each camera, such as {robot}/odom; auto: the root of its tree")
      .only_if(is_frame, "auto or a frame, in which {robot} stands for the robot");
}

std::string problem_of(const ExchangeNodeOptions& options) {
  const std::vector<std::string>& peers = options.peers;
  const auto is_peer = [&peers](const std::string& name) {
    return std::find(peers.begin(), peers.end(), name) != peers.end();
  };
  if (is_peer(options.robot)) {
    return "peers: " + options.robot + " is this robot itself, allowed: other robots";
  }
  for (const std::string& name : options.references) {
    if (!is_peer(name)) return "references: " + name + " is none of the peers";
  }
  return {};
}

}  // namespace rprr
