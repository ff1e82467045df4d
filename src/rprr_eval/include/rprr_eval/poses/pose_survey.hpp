// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rprr_eval/measure/frame_source.hpp"
#include "rprr_eval/measure/metrics.hpp"
#include "rprr_pose/registration.hpp"

namespace rprr {

/// Pairs are binned by the overlap of a and b under the true pose: bin i holds overlaps from
/// kOverlapBins[i] (included) up to that of the bin before.
struct OverlapBin {
  const char* name;
  double from;
};
constexpr std::array<OverlapBin, 5> kOverlapBins = {
    {{">= 0.7", 0.7}, {"0.5-0.7", 0.5}, {"0.3-0.5", 0.3}, {"0.05-0.3", 0.05}, {"none", -1.0}}};
std::size_t overlap_bin(double overlap);

/// An ordered pair of a folder's entries.
struct KnownPair {
  std::size_t a = 0;
  std::size_t b = 0;
  double overlap = 0.0;
  Pose truth = Pose::Identity();  // M_ab
};

/// Every ordered pair of a folder's entries with known poses, by bin.
struct KnownPairs {
  std::array<std::vector<KnownPair>, kOverlapBins.size()> bins;
  std::size_t entries_used = 0;  // of the folder's
};

/// Overlaps of all ordered pairs. Of a long folder, at most `most_entries` entries, spread evenly,
/// take part. Errors: no poses, images that cannot be read.
Result<KnownPairs> known_pairs(FrameSource& source, std::size_t most_entries);

/// At most `count` pairs of a bin, the same for the same seed.
std::vector<KnownPair> pick(const std::vector<KnownPair>& bin, std::size_t count,
                            std::uint32_t seed);

/// What one method made of one pair. Right and wrong as in metrics.hpp.
struct PairRecord {
  KnownPair pair;
  PoseError error;
  bool solved = false;  // the motion is right, whether or not the method vouches for it
  bool accepted = false;
  bool converged = false;  // by the method's own word
  std::size_t bytes = 0;
  double ms = 0.0;  // processor time

  bool accepted_right() const { return accepted && solved; }
  bool accepted_wrong() const { return accepted && is_wrong(error); }
};
PairRecord make_record(const KnownPair& pair, const RegistrationResult& result, double ms);

/// Runs a method on a pair from the identity and measures its processor time. Errors: images that
/// cannot be read.
Result<PairRecord> survey_pair(FrameSource& source, const KnownPair& pair, Registration& method);

/// What one method made of many pairs.
struct PoseTally {
  int pairs = 0;
  int solved = 0;
  int accepted = 0;
  int accepted_right = 0;
  int accepted_wrong = 0;               // the gap between right and wrong counts as neither
  std::vector<double> metres, degrees;  // errors of solved pairs
  std::vector<double> ms;               // processor time, all pairs
  std::vector<double> bytes;            // all pairs
  std::vector<KnownPair> wrong_pairs;   // those accepted and wrong

  void add(const PairRecord& record);
};
/// Counts the records in that bin, or all records.
PoseTally tally_of(const std::vector<PairRecord>& records, std::optional<std::size_t> bin);

/// Two methods on the same pairs.
struct HeadToHead {
  int both = 0, only_first = 0, only_other = 0, neither = 0;  // solved by
  PoseError first, other;     // median errors over pairs that both solve
  double times_slower = 0.0;  // the other's median time over the first's, all pairs
};
/// Records of the same pairs in the same order.
HeadToHead head_to_head(const std::vector<PairRecord>& first, const std::vector<PairRecord>& other);

}  // namespace rprr
