// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "rprr_eval/exchange/exchange_harness.hpp"
#include "rprr_eval/profile/profile.hpp"
#include "rprr_pose/registration.hpp"

namespace rprr {

/// Two robots that have not met, with the profile's protocol between them.
ExchangeHarness make_exchange(const Profile& profile, Duration one_way_latency);
/// Robots of these names: b refers to a.
ExchangeHarness make_exchange(const Profile& profile, const std::string& a, const std::string& b,
                              Duration one_way_latency);

/// The profile's protocol as a pose method: every call is the first exchange of two robots (cold);
/// bytes include both ways and the intrinsics. It chooses its start itself. Accepted is what the
/// reference decided; not converged: timed out, too few points, or out of iterations.
std::unique_ptr<Registration> make_exchange_registration(const std::string& name,
                                                         const Profile& profile);

/// A frame under another robot's name and stamp; the pixels stay where they are.
RgbdFramePtr as_frame_of(const RgbdFrame& frame, const std::string& robot, Stamp stamp);

}  // namespace rprr
