// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "rprr_pose/pose_verdict.hpp"
#include "rprr_pose/preview_agreement.hpp"

namespace rprr {

/// What tells right poses of two previews from wrong ones: of both ways, b in a's view and a in
/// b's, the worse.
struct PoseEvidence {
  double correlation = 0.0;       // of luma over cells whose depths agree
  double fine_correlation = 0.0;  // of what luma differs from its neighbourhood by
  double outliers = 1.0;          // share of the overlap whose depth fits nothing: not the surface,
                                  // not clearly before it, not clearly behind it
  double violating = 1.0;         // share of the overlap in seen free space
  double margin = 0.0;            // of the score over the best distinct other pose
};
PoseEvidence evidence_of(const Agreement& one, const Agreement& other, double margin);

/// The evidence as the terms in which the log odds are linear: both correlations through Fisher's
/// transform, and every term clipped, so that none can outweigh all others.
constexpr std::size_t kEvidenceTerms = 5;
std::array<double, kEvidenceTerms> terms_of(const PoseEvidence& evidence);

/// Logarithm of the odds that the pose is right rather than wrong: a logistic regression on what
/// the search found for pairs of synthetic rooms, turntables and corridors, and for frames of two
/// different places. `rprr_eval belief --scenes 150` printed the numbers (docs/pose.md).
double log_odds(const PoseEvidence& evidence);

/// Names the cause of low log odds: that of the term which takes most from them, compared to the
/// median of right poses. Both correlations stand for kColourDisagrees, outliers for
/// kDepthDisagrees, violating for kFreeSpaceViolated and margin for kAmbiguous.
PoseStatus weakest_evidence(const PoseEvidence& evidence);

}  // namespace rprr
