// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/pose_survey.hpp"

#include <algorithm>

#include "rprr_eval/processor_time.hpp"
#include "rprr_sensor/motion.hpp"
#include "rprr_sensor/random.hpp"

namespace rprr {
namespace {

std::vector<std::size_t> entries_with_pose(const TumFolder& folder, std::size_t most) {
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < folder.entries.size(); ++i) {
    if (folder.entries[i].world_from_camera) known.push_back(i);
  }
  if (known.size() <= most) return known;
  std::vector<std::size_t> spread;
  for (std::size_t i = 0; i < most; ++i) spread.push_back(known[i * known.size() / most]);
  return spread;
}

}  // namespace

std::size_t overlap_bin(double overlap) {
  std::size_t bin = 0;
  while (bin + 1 < kOverlapBins.size() && overlap < kOverlapBins[bin].from) ++bin;
  return bin;
}

Result<KnownPairs> known_pairs(FrameSource& source, std::size_t most_entries) {
  const TumFolder& folder = source.folder();
  const std::vector<std::size_t> entries = entries_with_pose(folder, most_entries);
  if (entries.size() < 2) {
    return Error{folder.path + ": no true poses (groundtruth.txt), which this needs"};
  }
  std::vector<PoseFramePtr> frames;
  for (const std::size_t entry : entries) {
    const Result<PoseFramePtr> frame = source.frame(entry);
    if (!frame) return Error{frame.reason()};
    frames.push_back(*frame);
  }
  KnownPairs pairs;
  pairs.entries_used = entries.size();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (i == k) continue;
      KnownPair pair{entries[i], entries[k], 0.0, Pose::Identity()};
      pair.truth = relative_motion(*folder.entries[pair.a].world_from_camera,
                                   *folder.entries[pair.b].world_from_camera);
      pair.overlap = overlap(frames[i]->depth, frames[i]->camera, frames[k]->depth,
                             frames[k]->camera, pair.truth);
      pairs.bins[overlap_bin(pair.overlap)].push_back(pair);
    }
  }
  return pairs;
}

std::vector<KnownPair> pick(const std::vector<KnownPair>& bin, std::size_t count,
                            std::uint32_t seed) {
  std::vector<KnownPair> shuffled = bin;
  Random random(seed);
  count = std::min(count, shuffled.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = static_cast<int>(shuffled.size() - i);
    std::swap(shuffled[i], shuffled[i + static_cast<std::size_t>(random.below(left))]);
  }
  shuffled.resize(count);
  return shuffled;
}

void PoseTally::add(const RegistrationResult& result, const Pose& truth, double milliseconds) {
  const PoseError error = pose_error(result.motion, truth);
  const bool right = is_right(error);
  ++pairs;
  ms.push_back(milliseconds);
  bytes.push_back(static_cast<double>(result.bytes));
  if (right) {
    ++solved;
    metres.push_back(error.metres);
    degrees.push_back(error.degrees);
  }
  if (!result.accepted) return;
  ++accepted;
  accepted_right += right ? 1 : 0;
  accepted_wrong += is_wrong(error) ? 1 : 0;
}

PoseTally& PoseTally::operator+=(const PoseTally& other) {
  pairs += other.pairs;
  solved += other.solved;
  accepted += other.accepted;
  accepted_right += other.accepted_right;
  accepted_wrong += other.accepted_wrong;
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(metres, other.metres);
  append(degrees, other.degrees);
  append(ms, other.ms);
  append(bytes, other.bytes);
  wrong_pairs.insert(wrong_pairs.end(), other.wrong_pairs.begin(), other.wrong_pairs.end());
  return *this;
}

Result<bool> survey_pair(FrameSource& source, const KnownPair& pair, Registration& method,
                         PoseTally& tally) {
  const Result<PoseFramePtr> a = source.frame(pair.a);
  if (!a) return Error{a.reason()};
  const Result<PoseFramePtr> b = source.frame(pair.b);
  if (!b) return Error{b.reason()};
  const ProcessorTime clock;
  const RegistrationResult result = method.align(**a, **b, Pose::Identity());
  const double ms = clock.ms();
  const int wrong_before = tally.accepted_wrong;
  tally.add(result, pair.truth, ms);
  if (tally.accepted_wrong > wrong_before) tally.wrong_pairs.push_back(pair);
  return true;
}

}  // namespace rprr
