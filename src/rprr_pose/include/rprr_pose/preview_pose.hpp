// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_pose/pose_evidence.hpp"
#include "rprr_pose/pose_verdict.hpp"
#include "rprr_pose/preview_agreement.hpp"
#include "rprr_pose/preview_alignment.hpp"
#include "rprr_pose/preview_starts.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {

struct SearchStage;

/// When a pose that was found from a preview is accepted.
struct PreviewLimits {
  double min_overlap = 0.22;    ///< share of either view's cells that fall into the other on depth
  double max_violating = 0.04;  ///< share of the overlap in seen free space, the worse way
  double min_evidence = 1.0;    ///< log odds of being right, pose_evidence.hpp
  double warm_evidence = 1.0;   ///< log odds beyond min_evidence for a pose without a search
  double min_margin = 0.06;     ///< share of the score between this pose and the next distinct one
  double max_sigma_translation = 0.03;  ///< standard deviation in the worst direction [m]
  double max_sigma_rotation = 0.015;    ///< standard deviation about the worst axis [rad]
};

struct PreviewPoseOptions {
  StartRange range;
  PreviewLimits limits;
};

/// The pose that was found from a preview, with what tells right from wrong.
struct PreviewPose {
  PoseVerdict verdict;                   ///< the first test that failed; accepted: the log odds
  Pose b_from_a = Pose::Identity();      ///< the paper's M_ab
  Matrix6 covariance = Matrix6::Zero();  ///< of b_from_a's left perturbation (tx ty tz rx ry rz)
  double score = 0.0;                    ///< how well the views match, 0 to 1
  double log_odds = 0.0;                 ///< of the pose being right
  PoseEvidence evidence;                 ///< from which log_odds is computed
  Agreement b_in_a, a_in_b;              ///< of b's cells in a's view, and of a's cells in b's
  AlignmentSums sums;                    ///< of the last alignment
  bool searched = false;                 ///< initial guesses were not enough
  int starts = 0;                        ///< distinct poses that the search was left with
};

/// The reference's side of protocol `preview`: finds the pose from b's preview alone, against a's
/// own frame. It keeps the views of a's frame while that stays the same. Threads: one object serves
/// one thread.
class PreviewPoseEstimator {
 public:
  explicit PreviewPoseEstimator(const PreviewPoseOptions& options) : options_(options) {}

  /// a: the reference's frame, with colour. warm: initial guesses of b_from_a (the last accepted
  /// pose, tf, odometry). The full search runs only if none of them is accepted with evidence to
  /// spare and without a rival along the directions that depth leaves free. Errors: the verdict
  /// says why there is no pose.
  PreviewPose estimate(const RgbdFrame& a, const BlockPreview& b, const Camera& b_camera,
                       const std::vector<Pose>& warm);

 private:
  struct Candidate {
    Pose a_from_b;
    double score = 0.0;
    Agreement b_in_a, a_in_b;
    AlignmentSums sums;
  };

  static bool better(const Candidate& left, const Candidate& right) {
    return left.score > right.score;
  }

  void prepare(const RgbdFrame& a);
  void narrow(std::vector<Candidate>& candidates, std::size_t level,
              const SearchStage& stage) const;
  void judge(Candidate& candidate) const;
  bool refine(Candidate& candidate) const;
  PreviewPose finish(const Candidate& best, double second) const;
  PoseVerdict why_nothing(Candidate start) const;
  bool stands_alone(const Candidate& warm) const;
  std::vector<Candidate> search(Candidate& best_start) const;
  void slide(const CoarseMatch& match, std::vector<Candidate>& candidates) const;

  PreviewPoseOptions options_;
  Stamp prepared_ = -1;
  std::vector<PreviewView> a_;   // block resolution first, then coarser and coarser
  std::vector<PreviewView> b_;   // block resolution first, then coarser and coarser
  MovingPoints refined_points_;  // of b_[0], for refine()
  FixedView fine_;               // a's own depth and luma
};

}  // namespace rprr
