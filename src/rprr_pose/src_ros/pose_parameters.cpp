// SPDX-License-Identifier: BSD-3-Clause
#include "pose_parameters.hpp"

#include <ros/console.h>
#include <ros/time.h>

#include <algorithm>

#include "pose_broadcaster.hpp"

namespace rprr {

namespace {

SamplesOptions read_samples_options(const Parameters& parameters) {
  SamplesOptions options;
  const auto seconds = [&](const char* name, Duration& value) {
    value = from_seconds(parameters.param(name, to_seconds(value)));
  };
  parameters.param("sample_count", options.sample_count, options.sample_count);
  parameters.param("max_iterations", options.max_iterations, options.max_iterations);
  parameters.param("converged_translation", options.converged_translation,
                   options.converged_translation);
  parameters.param("converged_rotation", options.converged_rotation, options.converged_rotation);
  parameters.param("resample", options.resample, options.resample);
  parameters.param("weigh_by_noise", options.by_noise, options.by_noise);
  parameters.param("local_start", options.local_start, options.local_start);
  VerificationLimits& limits = options.limits;
  parameters.param("min_overlap", limits.min_overlap, limits.min_overlap);
  parameters.param("min_consistent", limits.min_consistent, limits.min_consistent);
  parameters.param("max_violating", limits.max_violating, limits.max_violating);
  parameters.param("max_residual_sigmas", limits.max_residual_sigmas, limits.max_residual_sigmas);
  parameters.param("min_matched", limits.min_matched, limits.min_matched);
  parameters.param("max_sigma_translation", limits.max_sigma_translation,
                   limits.max_sigma_translation);
  parameters.param("max_sigma_rotation", limits.max_sigma_rotation, limits.max_sigma_rotation);
  seconds("step_timeout", options.step_timeout);
  seconds("min_period", options.min_period);
  seconds("silence_timeout", options.silence_timeout);
  seconds("max_frame_difference", options.max_stamp_difference);
  return options;
}

PreviewOptions read_preview_options(const Parameters& parameters) {
  PreviewOptions options;
  const auto seconds = [&](const char* name, Duration& value) {
    value = from_seconds(parameters.param(name, to_seconds(value)));
  };
  parameters.param("preview_step", options.step, options.step);
  parameters.param("preview_lossless", options.lossless_depth, options.lossless_depth);
  parameters.param("preview_quality", options.colour_quality, options.colour_quality);
  StartRange& range = options.search.range;
  parameters.param("search_yaw", range.yaw, range.yaw);
  parameters.param("search_pitch", range.pitch, range.pitch);
  parameters.param("search_roll", range.roll, range.roll);
  PreviewLimits& limits = options.search.limits;
  parameters.param("preview_min_overlap", limits.min_overlap, limits.min_overlap);
  parameters.param("preview_max_violating", limits.max_violating, limits.max_violating);
  parameters.param("preview_min_evidence", limits.min_evidence, limits.min_evidence);
  parameters.param("preview_min_margin", limits.min_margin, limits.min_margin);
  parameters.param("preview_warm_evidence", limits.warm_evidence, limits.warm_evidence);
  seconds("step_timeout", options.step_timeout);
  seconds("min_period", options.min_period);
  seconds("reference_age", options.reference_age);
  seconds("max_frame_difference", options.max_stamp_difference);
  return options;
}

bool uses_previews(const Parameters& parameters) {
  const auto protocol = parameters.param<std::string>("protocol", "preview");
  if (protocol != "preview" && protocol != "samples") {
    ROS_ERROR_STREAM("~protocol is '" << protocol
                                      << "'; it must be preview or samples: using preview");
  }
  return protocol != "samples";
}

}  // namespace

ExchangeNodeOptions read_node_options(const Parameters& parameters) {
  ExchangeNodeOptions options;
  options.robot = parameters.param<std::string>("robot", "");
  options.peers = parameters.param("peers", options.peers);
  options.references = parameters.param("references", options.references);
  options.use_previews = uses_previews(parameters);
  options.stale_overlap = parameters.param("stale_overlap", options.stale_overlap);
  options.link_recovery = parameters.param("link_recovery", options.link_recovery);
  return options;
}

std::string problem_of(const ExchangeNodeOptions& options) {
  const std::vector<std::string>& peers = options.peers;
  const auto among = [&peers](const std::string& name) {
    return std::find(peers.begin(), peers.end(), name) != peers.end();
  };
  if (options.robot.empty()) return "~robot is not set: give the name of the robot";
  if (among(options.robot)) return "~peers names this robot, '" + options.robot + "', itself";
  for (const std::string& name : options.references) {
    if (!among(name)) return "~references names '" + name + "', which is none of ~peers";
  }
  return {};
}

ExchangeOptions read_exchange_options(const Parameters& parameters) {
  ExchangeOptions options;
  options.use_previews = uses_previews(parameters);
  options.preview = read_preview_options(parameters);
  options.samples = read_samples_options(parameters);
  // A robot that restarts must not count through numbers that its peers still remember.
  const std::uint32_t first = static_cast<std::uint32_t>(ros::WallTime::now().sec) << 8 | 1;
  options.preview.first_exchange = first;
  options.samples.first_exchange = first;
  return options;
}

std::optional<TfPriorOptions> read_tf_prior_options(const Parameters& parameters,
                                                    const std::string& robot,
                                                    const std::string& peer) {
  if (!parameters.param("tf_prior", true)) return std::nullopt;
  TfPriorOptions options;
  options.robot = robot;
  options.peer = peer;
  const auto frame = [&parameters](const char* name) {
    const auto given = parameters.param<std::string>(name, "auto");
    return given == "auto" ? std::string() : given;
  };
  options.fixed_frame = frame("tf_prior_fixed_frame");
  options.odom_frame = frame("tf_prior_odom_frame");
  options.publishes_root = PoseBroadcaster::publishes_root(parameters);
  return options;
}

}  // namespace rprr
