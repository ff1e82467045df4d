// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/poses/pose_survey.hpp"

#include <algorithm>

#include "rprr_eval/measure/median.hpp"
#include "rprr_eval/measure/processor_time.hpp"
#include "rprr_geometry/relative_pose.hpp"
#include "rprr_synthetic/random.hpp"

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
  std::vector<RgbdFramePtr> frames;
  for (const std::size_t entry : entries) {
    const Result<RgbdFramePtr> frame = source.frame(entry);
    if (!frame) return Error{frame.reason()};
    frames.push_back(*frame);
  }
  KnownPairs pairs;
  pairs.entries_used = entries.size();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (i == k) continue;
      KnownPair pair{entries[i], entries[k], 0.0, Pose::Identity()};
      pair.truth = relative_pose_of(*folder.entries[pair.a].world_from_camera,
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

PairRecord make_record(const KnownPair& pair, const RegistrationResult& result, double ms) {
  PairRecord record;
  record.pair = pair;
  record.error = pose_error(result.b_from_a, pair.truth);
  record.solved = is_right(record.error);
  record.accepted = result.accepted;
  record.converged = result.converged;
  record.bytes = result.bytes;
  record.ms = ms;
  return record;
}

Result<PairRecord> survey_pair(FrameSource& source, const KnownPair& pair, Registration& method) {
  const Result<RgbdFramePtr> a = source.frame(pair.a);
  if (!a) return Error{a.reason()};
  const Result<RgbdFramePtr> b = source.frame(pair.b);
  if (!b) return Error{b.reason()};
  const ProcessorTime clock;
  const RegistrationResult result = method.align(**a, **b, Pose::Identity());
  return make_record(pair, result, clock.ms());
}

void PoseTally::add(const PairRecord& record) {
  ++pairs;
  ms.push_back(record.ms);
  bytes.push_back(static_cast<double>(record.bytes));
  if (record.solved) {
    ++solved;
    metres.push_back(record.error.metres);
    degrees.push_back(record.error.degrees);
  }
  accepted += record.accepted ? 1 : 0;
  accepted_right += record.accepted_right() ? 1 : 0;
  if (!record.accepted_wrong()) return;
  ++accepted_wrong;
  wrong_pairs.push_back(record.pair);
}

PoseTally tally_of(const std::vector<PairRecord>& records, std::optional<std::size_t> bin) {
  PoseTally tally;
  for (const PairRecord& record : records) {
    if (!bin || overlap_bin(record.pair.overlap) == *bin) tally.add(record);
  }
  return tally;
}

HeadToHead head_to_head(const std::vector<PairRecord>& first,
                        const std::vector<PairRecord>& other) {
  HeadToHead out;
  std::array<std::vector<double>, 2> metres, degrees, ms;
  for (std::size_t i = 0; i < std::min(first.size(), other.size()); ++i) {
    ms[0].push_back(first[i].ms);
    ms[1].push_back(other[i].ms);
    if (!first[i].solved || !other[i].solved) {
      ++(first[i].solved ? out.only_first : other[i].solved ? out.only_other : out.neither);
      continue;
    }
    ++out.both;
    metres[0].push_back(first[i].error.metres);
    metres[1].push_back(other[i].error.metres);
    degrees[0].push_back(first[i].error.degrees);
    degrees[1].push_back(other[i].error.degrees);
  }
  out.first = {median(metres[0]), median(degrees[0])};
  out.other = {median(metres[1]), median(degrees[1])};
  const double own = median(ms[0]);
  if (own > 0.0) out.times_slower = median(ms[1]) / own;
  return out;
}

}  // namespace rprr
