// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/pose_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace rprr {
namespace {

// From rprr_eval belief --scenes 150: for the terms in their order, then the constant.
constexpr std::array<double, kEvidenceTerms> kSlopes = {2.28, 9.55, -10.54, -37.23, 11.37};
constexpr double kConstant = -7.41;
// Medians of the terms of right poses, as `rprr_eval belief` printed them.
constexpr std::array<double, kEvidenceTerms> kTypical = {1.80, 0.68, 0.00, 0.00, 0.30};
constexpr std::array<PoseStatus, kEvidenceTerms> kCauses = {
    PoseStatus::kColourDisagrees, PoseStatus::kColourDisagrees, PoseStatus::kDepthDisagrees,
    PoseStatus::kFreeSpaceViolated, PoseStatus::kAmbiguous};

double odd_share(const Agreement& way) {
  return 1.0 - way.of_overlap(way.consistent + way.violating + way.hidden);
}

}  // namespace

PoseEvidence evidence_of(const Agreement& one, const Agreement& other, double margin) {
  PoseEvidence evidence;
  evidence.correlation = std::min(one.correlation, other.correlation);
  evidence.fine_correlation = std::min(one.fine_correlation, other.fine_correlation);
  evidence.outliers = std::max(odd_share(one), odd_share(other));
  evidence.violating = std::max(one.of_overlap(one.violating), other.of_overlap(other.violating));
  evidence.margin = margin;
  return evidence;
}

std::array<double, kEvidenceTerms> terms_of(const PoseEvidence& evidence) {
  return {std::atanh(std::clamp(evidence.correlation, -0.98, 0.98)),
          std::atanh(std::clamp(evidence.fine_correlation, -0.9, 0.9)),
          std::clamp(evidence.outliers, 0.0, 0.3), std::clamp(evidence.violating, 0.0, 0.1),
          std::clamp(evidence.margin, 0.0, 0.3)};
}

double log_odds(const PoseEvidence& evidence) {
  const std::array<double, kEvidenceTerms> terms = terms_of(evidence);
  double sum = kConstant;
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) sum += kSlopes[i] * terms[i];
  return sum;
}

PoseStatus weakest_evidence(const PoseEvidence& evidence) {
  const std::array<double, kEvidenceTerms> terms = terms_of(evidence);
  std::array<double, kEvidenceTerms> losses{};
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    losses[i] = kSlopes[i] * (kTypical[i] - terms[i]);
  }
  return kCauses[static_cast<std::size_t>(std::max_element(losses.begin(), losses.end()) -
                                          losses.begin())];
}

}  // namespace rprr
