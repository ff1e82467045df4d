// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "rprr_eval/frame_source.hpp"
#include "rprr_eval/metrics.hpp"
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

/// What one method made of one bin's pairs. Right and wrong as in metrics.hpp.
struct PoseTally {
  int pairs = 0;
  int solved = 0;  // the motion is right, whether or not the method vouches for it
  int accepted = 0;
  int accepted_right = 0;
  int accepted_wrong = 0;               // the gap between right and wrong counts as neither
  std::vector<double> metres, degrees;  // errors of solved pairs
  std::vector<double> ms;               // processor time, all pairs
  std::vector<double> bytes;            // all pairs
  std::vector<KnownPair> wrong_pairs;   // those accepted and wrong (survey_pair)

  void add(const RegistrationResult& result, const Pose& truth, double milliseconds);
  PoseTally& operator+=(const PoseTally& other);
};

/// Runs a method on a pair from the identity and measures its processor time.
Result<bool> survey_pair(FrameSource& source, const KnownPair& pair, Registration& method,
                         PoseTally& tally);

}  // namespace rprr
