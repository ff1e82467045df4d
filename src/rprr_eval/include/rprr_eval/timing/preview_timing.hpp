// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rprr_eval/poses/methods.hpp"
#include "rprr_eval/profile/profile.hpp"
#include "rprr_geometry/rgbd_frame.hpp"

namespace rprr {

/// Processor times of the preview protocol's stages on one pair, milliseconds.
struct PreviewTimes {
  double make = 0.0;     // b: the frame's preview
  double encode = 0.0;   // b: its message
  double decode = 0.0;   // a: the preview from the message
  double prepare = 0.0;  // a: its own frame, once for all peers
  double cold = 0.0;     // a: the search, by robots that have not met
  bool accepted = false;
  /// The following hold if the search's pose was accepted.
  bool warm_verified = false;  // the warm start did, so that no search was needed
  double warm = 0.0;           // a: from a pose near the last accepted one

  double all_warm() const { return make + encode + decode + prepare + warm; }
  double all_cold() const { return make + encode + decode + prepare + cold; }
};

/// A peer's times on the same pair, from both frames as they are.
struct PeerTimes {
  double cold = 0.0;  // from the identity
  double warm = 0.0;  // from the same pose as the preview's warm start; 0 without one
};

struct PairTimes {
  PreviewTimes preview;
  std::vector<PeerTimes> peers;  // in the order of the methods
};

/// How far the warm start is from the accepted pose: about what two robots move between frames.
struct WarmStart {
  double metres = 0.02;
  double degrees = 1.0;
  std::uint32_t seed = 1;  // of its directions
};

/// Times the preview estimator by itself and the peers, `number` telling the pair's random
/// directions apart. Frames need colour.
PairTimes time_pair(const RgbdFrame& a, const RgbdFrame& b, const Profile& profile,
                    const NamedRegistrations& peers, const WarmStart& warm, std::uint32_t number);

/// Median and 95th percentile.
struct TimeSpread {
  std::size_t pairs = 0;
  double median = 0.0;
  double p95 = 0.0;
};
TimeSpread spread(const std::vector<double>& times);

/// A line of the result: a stage, or a method from end to end.
struct TimingRow {
  std::string name;
  TimeSpread time;
};

/// Over all pairs. Warm: over pairs with a verified warm start, the same for the peers.
struct TimingSummary {
  std::size_t pairs = 0, accepted = 0, warm_verified = 0;
  TimingRow make, encode, decode, prepare, warm, cold;  // stages
  TimingRow all_warm, all_cold;                         // both robots, all stages
  std::vector<TimingRow> peers_warm, peers_cold;
};
TimingSummary summarise(const std::vector<PairTimes>& times,
                        const std::vector<std::string>& peer_names);

}  // namespace rprr
