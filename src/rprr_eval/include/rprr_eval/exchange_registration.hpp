// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "rprr_eval/exchange_harness.hpp"
#include "rprr_pose/registration.hpp"
#include "rprr_pose/samples_protocol.hpp"

namespace rprr {

/// Two robots that have not met, with the `samples` protocol of these options between them.
ExchangeHarness make_samples_exchange(const SamplesOptions& options, Duration one_way_latency);

/// The `samples` protocol as a pose method: every call is the first exchange of two robots, bytes
/// include both ways and the intrinsics. It chooses its start itself; accepted is what the
/// reference decided; not converged: timed out, too few points, or out of iterations.
std::unique_ptr<Registration> make_samples_registration(const std::string& name,
                                                        const SamplesOptions& options);

/// A frame under another robot's name and stamp; the pixels stay where they are.
PoseFramePtr as_frame_of(const PoseFrame& frame, const std::string& robot, Stamp stamp);

}  // namespace rprr
