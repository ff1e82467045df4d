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

/// When a pose found from a preview is believed.
struct PreviewLimits {
  double min_overlap = 0.22;    // share of either view's cells that fall into the other on depth
  double max_violating = 0.04;  // share of those in seen free space, the worse way
  double min_evidence = 1.0;    // log odds of being right, pose_evidence.hpp
  double warm_evidence = 1.0;   // what a pose found without the search needs beyond that
  double min_margin = 0.06;     // of the score over the best distinct other pose
  double max_sigma_translation = 0.03;  // metres, in the worst direction
  double max_sigma_rotation = 0.015;    // rad, likewise
};

struct PreviewPoseOptions {
  StartRange range;
  PreviewLimits limits;
};

/// What came of it.
struct PreviewPose {
  PoseVerdict verdict;                   // the first test that failed; accepted: the log odds
  Pose b_from_a = Pose::Identity();      // the paper's M_ab
  Matrix6 covariance = Matrix6::Zero();  // of the left perturbation (tx ty tz rx ry rz) of M_ab
  double score = 0.0;                    // of the pose
  double log_odds = 0.0;                 // of being right
  PoseEvidence evidence;                 // what they come from
  Agreement b_in_a, a_in_b;
  AlignmentSums sums;
  bool searched = false;  // the full search was needed
  int starts = 0;
};

/// The reference's side of the `preview` protocol: from b's preview alone, against a's own frame.
/// Keeps a's views while the frame stays the same. One object serves one thread.
class PreviewPoseEstimator {
 public:
  explicit PreviewPoseEstimator(const PreviewPoseOptions& options) : options_(options) {}

  /// a: the reference's frame, with colour. warm: poses worth trying first (the last accepted one,
  /// tf, odometry); the full search runs only if none of them verifies, with evidence to spare and
  /// without a rival along the directions that depth leaves free.
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
  void narrow(std::vector<Candidate>& candidates, std::size_t level, int stride,
              const AlignmentOptions& options, std::size_t keep, double metres,
              double degrees) const;
  void judge(Candidate& candidate) const;
  bool refine(Candidate& candidate) const;
  PreviewPose finish(const Candidate& best, double second) const;
  PoseVerdict why_nothing(Candidate start) const;
  bool stands_alone(const Candidate& warm) const;
  std::vector<Candidate> search(Candidate& best_start) const;
  void slide(const CoarseMatch& match, std::vector<Candidate>& candidates) const;

  PreviewPoseOptions options_;
  Stamp prepared_ = -1;
  std::vector<PreviewView> a_;  // full block resolution first
  std::vector<PreviewView> b_;
  MovingPoints refined_points_;  // of b_'s first, for refine()
  FixedView fine_;
};

}  // namespace rprr
