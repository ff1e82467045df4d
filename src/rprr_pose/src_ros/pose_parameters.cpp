// SPDX-License-Identifier: BSD-3-Clause
#include "pose_parameters.hpp"

namespace rprr {

SamplesOptions read_samples_options(const ros::NodeHandle& private_nh, const std::string& robot,
                                    const std::string& peer) {
  SamplesOptions options;
  options.self = robot;
  options.peer = peer;
  const auto seconds = [&](const char* name, Duration& value) {
    value = from_seconds(private_nh.param(name, to_seconds(value)));
  };
  private_nh.param("sample_count", options.sample_count, options.sample_count);
  private_nh.param("max_iterations", options.max_iterations, options.max_iterations);
  private_nh.param("converged_translation", options.converged_translation,
                   options.converged_translation);
  private_nh.param("converged_rotation", options.converged_rotation, options.converged_rotation);
  private_nh.param("resample", options.resample, options.resample);
  private_nh.param("weigh_by_noise", options.by_noise, options.by_noise);
  private_nh.param("local_start", options.local_start, options.local_start);
  VerificationLimits& limits = options.limits;
  private_nh.param("min_overlap", limits.min_overlap, limits.min_overlap);
  private_nh.param("min_consistent", limits.min_consistent, limits.min_consistent);
  private_nh.param("max_violating", limits.max_violating, limits.max_violating);
  private_nh.param("max_residual_sigmas", limits.max_residual_sigmas, limits.max_residual_sigmas);
  private_nh.param("min_matched", limits.min_matched, limits.min_matched);
  private_nh.param("max_sigma_translation", limits.max_sigma_translation,
                   limits.max_sigma_translation);
  private_nh.param("max_sigma_rotation", limits.max_sigma_rotation, limits.max_sigma_rotation);
  seconds("step_timeout", options.step_timeout);
  seconds("min_period", options.min_period);
  seconds("silence_timeout", options.silence_timeout);
  seconds("max_frame_difference", options.max_stamp_difference);
  return options;
}

}  // namespace rprr
