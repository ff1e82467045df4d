// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "rprr_geometry/stamp.hpp"
#include "rprr_pose/exchange.hpp"
#include "rprr_pose/sampling.hpp"
#include "rprr_pose/verification.hpp"

namespace rprr {

/// Settings of the `samples` protocol (the paper's cooperative estimation). Only the reference's
/// settings shape the estimate; the dependent follows what it is asked.
struct SamplesOptions {
  int sample_count = kSampleCount;      // points a robot sends
  int max_iterations = 20;              // from a local start a few are enough; the paper: 50
  double converged_translation = 1e-3;  // a smaller step ends the iteration [m]; ours, since
                                        // those of Lui et al. are not public
  double converged_rotation = 1e-3;     // a smaller step ends the iteration [rad]
  bool resample = false;    // new points in every iteration (paper) or one set for an exchange
  bool by_noise = true;     // see IcpWeights
  bool local_start = true;  // reference: align b's points alone to Z_a before asking b again
  VerificationLimits limits;
  Duration step_timeout = from_seconds(1.0);  // for the peer's answer
  Duration min_period = 0;                    // reference: between starts of exchanges
  Duration silence_timeout =
      from_seconds(1.0);  // dependent: unclaimed frames go out whole after this
  Duration max_stamp_difference = from_seconds(0.05);  // dependent: between the two robots' frames
  std::size_t frames_kept = 30;                        // dependent: recent frames to choose from
  std::uint32_t first_exchange = 1;  // reference: number of the first exchange, not 0
};

/// Robot self as the reference of one peer: samples, asks, solves, verifies, tells the pose.
std::unique_ptr<ExchangeRole> make_samples_reference(const std::string& self,
                                                     const std::string& peer,
                                                     const SamplesOptions& options);
/// Robot self as the dependent of one peer: answers with its points and its half of the normal
/// equations.
std::unique_ptr<ExchangeRole> make_samples_dependent(const std::string& self,
                                                     const std::string& peer,
                                                     const SamplesOptions& options);

}  // namespace rprr
