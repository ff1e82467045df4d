// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/timing/preview_timing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "rprr_eval/measure/median.hpp"
#include "rprr_eval/measure/processor_time.hpp"
#include "rprr_synthetic/random.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

Eigen::Vector3d direction(Random& random) {
  Eigen::Vector3d v;
  do {
    for (int i = 0; i < 3; ++i) v[i] = random.between(-1.0, 1.0);
  } while (v.norm() < 0.1 || v.norm() > 1.0);
  return v.normalized();
}

Pose near(const Pose& pose, const WarmStart& warm, std::uint32_t number) {
  Random random((std::uint64_t{warm.seed} << 32) + number);
  Twist twist;
  twist.head<3>() = warm.metres * direction(random);
  twist.tail<3>() = warm.degrees * M_PI / 180.0 * direction(random);
  return exp_se3(twist) * pose;
}

template <typename Action>
double timed(const Action& action) {
  const ProcessorTime clock;
  action();
  return clock.ms();
}

// The start that was measured from, if there was one.
std::optional<Pose> time_preview(RgbdFrame a, const RgbdFrame& b, const Profile& profile,
                                 const WarmStart& warm, std::uint32_t number, PreviewTimes& out) {
  std::optional<BlockPreview> preview;
  out.make = timed([&] { preview = make_preview(b.depth, b.bgr, profile.preview.step); });
  Bytes message;
  out.encode = timed([&] { message = encode_preview(*preview, profile.preview.colour_quality); });
  out.decode = timed([&] { preview = *decode_preview(message); });

  PreviewPoseEstimator estimator(profile.preview.search);
  const auto estimate = [&](const std::vector<Pose>& starts) {
    return estimator.estimate(a, *preview, b.camera, starts);
  };
  // The estimator keeps what it prepared of a frame: the first estimate of a stamp prepares, the
  // next one does not, and a's preparation is the difference.
  a.stamp = 1;
  const PreviewPose first = estimate({});
  out.cold = timed([&] { estimate({}); });
  out.accepted = first.verdict.accepted();
  const Pose start = near(first.b_from_a, warm, number);
  const std::vector<Pose> starts(1, start);
  PreviewPose found;
  out.warm = timed([&] { found = estimate(starts); });
  out.warm_verified = out.accepted && !found.searched;
  a.stamp = 2;
  const double with_preparation = timed([&] { estimate(starts); });
  out.prepare = std::max(0.0, with_preparation - out.warm);
  if (!out.warm_verified) return std::nullopt;
  return start;
}

TimingRow row(std::string name, const std::vector<PairTimes>& times, bool warm_only,
              const std::function<double(const PairTimes&)>& field) {
  std::vector<double> values;
  for (const PairTimes& pair : times) {
    if (!warm_only || pair.preview.warm_verified) values.push_back(field(pair));
  }
  return {std::move(name), spread(values)};
}

}  // namespace

PairTimes time_pair(const RgbdFrame& a, const RgbdFrame& b, const Profile& profile,
                    const NamedRegistrations& peers, const WarmStart& warm, std::uint32_t number) {
  PairTimes out;
  const std::optional<Pose> start = time_preview(a, b, profile, warm, number, out.preview);
  for (const auto& peer : peers) {
    PeerTimes times;
    times.cold = timed([&] { peer->align(a, b, Pose::Identity()); });
    if (start) times.warm = timed([&] { peer->align(a, b, *start); });
    out.peers.push_back(times);
  }
  return out;
}

TimeSpread spread(const std::vector<double>& times) {
  return {times.size(), median(times), percentile(times, 0.95)};
}

TimingSummary summarise(const std::vector<PairTimes>& times,
                        const std::vector<std::string>& peer_names) {
  TimingSummary out;
  out.pairs = times.size();
  for (const PairTimes& pair : times) {
    out.accepted += pair.preview.accepted ? 1 : 0;
    out.warm_verified += pair.preview.warm_verified ? 1 : 0;
  }
  const auto stage = [&](const char* name, bool warm_only, double PreviewTimes::*field) {
    return row(name, times, warm_only, [field](const PairTimes& p) { return p.preview.*field; });
  };
  out.make = stage("b: make a preview", false, &PreviewTimes::make);
  out.encode = stage("b: code it", false, &PreviewTimes::encode);
  out.decode = stage("a: decode it", false, &PreviewTimes::decode);
  out.prepare = stage("a: prepare its own frame", false, &PreviewTimes::prepare);
  out.warm = stage("a: warm start, verified", true, &PreviewTimes::warm);
  out.cold = stage("a: cold search", false, &PreviewTimes::cold);
  out.all_warm = row("preview, warm, all stages", times, true,
                     [](const PairTimes& p) { return p.preview.all_warm(); });
  out.all_cold = row("preview, cold, all stages", times, false,
                     [](const PairTimes& p) { return p.preview.all_cold(); });
  for (std::size_t i = 0; i < peer_names.size(); ++i) {
    out.peers_warm.push_back(row(peer_names[i] + ", warm", times, true,
                                 [i](const PairTimes& p) { return p.peers[i].warm; }));
    out.peers_cold.push_back(row(peer_names[i] + ", cold", times, false,
                                 [i](const PairTimes& p) { return p.peers[i].cold; }));
  }
  return out;
}

}  // namespace rprr
