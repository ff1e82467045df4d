// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_pose.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "agreement_weights.hpp"
#include "pose_check.hpp"
#include "rprr_pose/frame_views.hpp"

namespace rprr {

// One stage of the search: all candidates are aligned, and the best distinct ones are kept.
struct SearchStage {
  int stride;        // between the points of b's view that are aligned, both ways [cells]
  int iterations;    // of the alignment
  float gate;        // of its first iteration, AlignmentOptions::gate [m]
  float last_gate;   // of its last iteration [m]
  std::size_t keep;  // candidates at most
  double metres;     // two candidates are the same pose if they are nearer than this [m]
  double degrees;    // and turned by less than this [degrees]

  AlignmentOptions alignment() const {
    AlignmentOptions options;
    options.iterations = iterations;
    options.gate = gate;
    options.last_gate = last_gate;
    return options;
  }
};

namespace {

constexpr double kDegree = M_PI / 180.0;

// The numbers of the search weigh right poses against time. `rprr_eval poses` and `rprr_eval
// timing` print what they give (docs/pose.md).

constexpr SearchStage kFirstStage{3, 6, 0.6f, 0.25f, 40, 0.04, 1.5};  // at half resolution
constexpr SearchStage kSecondStage{2, 5, 0.5f, 0.2f, 14, 0.05, 2.0};  // at half resolution
constexpr SearchStage kSlidStage{3, 4, 0.25f, 0.2f, 12, 0.05, 2.0};   // at half resolution
constexpr SearchStage kBlockStage{3, 4, 0.25f, 0.12f, 6, 0.05, 2.0};  // at block resolution
// The last alignment, of every second point of b to a's own depth, neither kept nor dropped.
constexpr SearchStage kRefinement{2, 10, 0.12f, 0.05f, 0, 0.0, 0.0};
constexpr std::size_t kRefined = 4;  // candidates that are refined

constexpr std::size_t kSlid = 6;     // candidates that are also tried some way along
constexpr double kSlideStep = 0.25;  // [m] how far luma can tell
constexpr double kMetresPerRadian =
    2.0;                         // [m] at this distance a turn moves what is seen as a step
constexpr double kRival = 0.75;  // of a warm pose's score: another pose that scores more is a rival
// Two poses that differ by more than either of these are different answers: about twice what counts
// as a right pose (8 cm, 3 degrees).
constexpr double kDistinctMetres = 0.15;
constexpr double kDistinctDegrees = 6.0;

// True poses of views that overlap by half must not lose to wrong ones that overlap by more.
constexpr double kOverlapPower = 0.4;
constexpr int kFewestCells = 40;  // cells with depth, since align() gives up below 40 residuals

bool differ(const Pose& left, const Pose& right, double metres, double degrees) {
  return (left.translation() - right.translation()).norm() > metres ||
         rotation_angle(left.linear() * right.linear().transpose()) > degrees * kDegree;
}

// A pose has to pass these tests. They stand in the order in which they are made.
constexpr std::size_t kLogOddsCheck = 2;
std::array<PoseCheck, 6> checks_of(const PreviewPose& pose, const PreviewLimits& limits) {
  return {
      {{PoseStatus::kLittleOverlap, PoseQuantity::kOverlap,
        std::min(pose.b_in_a.overlap(), pose.a_in_b.overlap()), limits.min_overlap},
       {PoseStatus::kFreeSpaceViolated, PoseQuantity::kFreeSpace, pose.evidence.violating,
        limits.max_violating},
       {weakest_evidence(pose.evidence), PoseQuantity::kLogOdds, pose.log_odds,
        limits.min_evidence},
       {PoseStatus::kFreeDirection, PoseQuantity::kTranslationSigma,
        worst_sigma(pose.covariance.topLeftCorner<3, 3>()), limits.max_sigma_translation},
       {PoseStatus::kFreeDirection, PoseQuantity::kRotationSigma,
        worst_sigma(pose.covariance.bottomRightCorner<3, 3>()), limits.max_sigma_rotation},
       {PoseStatus::kAmbiguous, PoseQuantity::kMargin, pose.evidence.margin, limits.min_margin}}};
}

}  // namespace

void PreviewPoseEstimator::prepare(const RgbdFrame& a) {
  if (prepared_ == a.stamp && !a_.empty()) return;
  prepared_ = a.stamp;
  a_ = pyramid(make_view(make_preview(a.depth, a.bgr), a.camera));
  fine_ = fine_view(a);
}

void PreviewPoseEstimator::judge(Candidate& candidate) const {
  candidate.b_in_a = agreement(b_[0], a_[0], candidate.a_from_b);
  candidate.a_in_b = agreement(a_[0], b_[0], candidate.a_from_b.inverse());
  const auto one_way = [](const Agreement& way) {
    const double agreement = way.of_overlap(way.consistent - kViolatingWeight * way.violating -
                                            kHiddenWeight * way.hidden);
    return std::max(0.0, agreement) * std::pow(way.overlap(), kOverlapPower);
  };
  const double geometry = 0.5 * (one_way(candidate.b_in_a) + one_way(candidate.a_in_b));
  const double colour = 0.5 * (candidate.b_in_a.correlation + candidate.b_in_a.fine_correlation);
  candidate.score = geometry * std::max(0.0, colour);
}

bool PreviewPoseEstimator::refine(Candidate& candidate) const {
  AlignmentOptions options = kRefinement.alignment();
  options.scatter = true;
  FixedView fixed = fine_;
  fixed.cells = &a_[0];
  return align(refined_points_, fixed, options, candidate.a_from_b, candidate.sums);
}

// Aligns every candidate a little further, then keeps the best distinct ones.
void PreviewPoseEstimator::narrow(std::vector<Candidate>& candidates, std::size_t level,
                                  const SearchStage& stage) const {
  FixedView fixed;
  fixed.cells = &a_[level];
  const MovingPoints points = points_of(b_[level], stage.stride);
  const AlignmentOptions options = stage.alignment();
  for (Candidate& candidate : candidates) {
    const bool found = align(points, fixed, options, candidate.a_from_b, candidate.sums);
    candidate.score = found ? candidate.sums.score() : 0.0;
  }
  std::stable_sort(candidates.begin(), candidates.end(), better);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    if (kept.size() >= stage.keep || candidate.score <= 0.0) break;
    if (std::all_of(kept.begin(), kept.end(), [&](const Candidate& other) {
          return differ(candidate.a_from_b, other.a_from_b, stage.metres, stage.degrees);
        })) {
      kept.push_back(candidate);
    }
  }
  candidates = std::move(kept);
}

// Adds candidates. Along a corridor or a wall depth lets a pose slide, and what repeats there fits
// again further on. So the best candidates are moved along the two directions that depth knows
// least: a small step, whose end luma can tell apart, and to every place where the coarsest views
// match once more.
void PreviewPoseEstimator::slide(const CoarseMatch& match,
                                 std::vector<Candidate>& candidates) const {
  const std::size_t count = std::min(candidates.size(), kSlid);
  for (std::size_t i = 0; i < count; ++i) {
    Matrix6 scaled = candidates[i].sums.geometric;
    scaled.rightCols<3>() /= kMetresPerRadian;
    scaled.bottomRows<3>() /= kMetresPerRadian;
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(scaled);
    const Pose from = candidates[i].a_from_b;
    for (int k = 0; k < 2; ++k) {
      Twist direction = eigen.eigenvectors().col(k);
      direction.tail<3>() /= kMetresPerRadian;
      std::vector<double> distances = matches_along(match, from, direction);
      distances.insert(distances.end(), {-kSlideStep, kSlideStep});
      for (const double metres : distances) {
        candidates.emplace_back();
        candidates.back().a_from_b = exp_se3(metres * direction) * from;
      }
    }
  }
}

// Finds the distinct poses that align and puts the best one first. best_start becomes the most
// promising start; it stays as it was if there is no start.
std::vector<PreviewPoseEstimator::Candidate> PreviewPoseEstimator::search(
    Candidate& best_start) const {
  const std::size_t coarsest = std::min(a_.size(), b_.size()) - 1;
  const std::size_t middle = coarsest - 1;
  const CoarseMatch match(b_[coarsest], a_[coarsest]);
  std::vector<Candidate> candidates;
  for (const Pose& start : find_starts(match, options_.range)) {
    candidates.emplace_back();
    candidates.back().a_from_b = start;
  }
  if (!candidates.empty()) best_start = candidates.front();
  narrow(candidates, middle, kFirstStage);
  narrow(candidates, middle, kSecondStage);
  slide(match, candidates);
  narrow(candidates, middle, kSlidStage);
  narrow(candidates, 0, kBlockStage);
  for (Candidate& candidate : candidates) judge(candidate);
  std::stable_sort(candidates.begin(), candidates.end(), better);
  if (candidates.size() > kRefined) candidates.resize(kRefined);
  for (Candidate& candidate : candidates) {
    if (refine(candidate)) judge(candidate);
  }
  std::stable_sort(candidates.begin(), candidates.end(), better);
  return candidates;
}

PreviewPose PreviewPoseEstimator::finish(const Candidate& best, double second) const {
  PreviewPose out;
  out.b_from_a = best.a_from_b.inverse();
  out.score = best.score;
  const double margin = best.score > 0.0 ? (best.score - second) / best.score : 0.0;
  out.evidence = evidence_of(best.b_in_a, best.a_in_b, margin);
  out.log_odds = log_odds(out.evidence);
  out.b_in_a = best.b_in_a;
  out.a_in_b = best.a_in_b;
  out.sums = best.sums;
  // Left perturbation of b-to-a carried over to a-to-b.
  const Matrix6 a = adjoint(out.b_from_a);
  out.covariance = a * covariance_of(best.sums) * a.transpose();

  const auto checks = checks_of(out, options_.limits);
  const PoseCheck* failed = first_failed(checks);
  out.verdict = failed ? failed->rejected() : checks[kLogOddsCheck].accepted();
  return out;
}

// Tells why the search was left without a pose, from what the most promising start looks like.
PoseVerdict PreviewPoseEstimator::why_nothing(Candidate start) const {
  const int cells = std::min(a_[0].valid_count(), b_[0].valid_count());
  if (cells < kFewestCells) {
    return make_verdict(PoseStatus::kTooFewPoints, PoseQuantity::kValidPoints, cells, kFewestCells);
  }
  judge(start);
  start.score = 0.0;  // the start did not align, so that it stands out from nothing
  const PoseVerdict verdict = finish(start, 0.0).verdict;
  return verdict.accepted() ? PoseVerdict{PoseStatus::kNotConverged} : verdict;
}

// Whether no rival fits about as well as a pose from an initial guess, which was compared with no
// other pose so far. Its rivals are the places where the views match once more, along the
// directions in which depth leaves it free to slide.
bool PreviewPoseEstimator::stands_alone(const Candidate& warm) const {
  const std::size_t coarsest = std::min(a_.size(), b_.size()) - 1;
  std::vector<Candidate> candidates{warm};
  slide(CoarseMatch(b_[coarsest], a_[coarsest]), candidates);
  SearchStage stage = kSlidStage;
  stage.keep = candidates.size();
  narrow(candidates, coarsest - 1, stage);
  double own = 0.0;
  double rival = 0.0;
  for (const Candidate& candidate : candidates) {
    const bool other = differ(candidate.a_from_b, warm.a_from_b, kDistinctMetres, kDistinctDegrees);
    double& score = other ? rival : own;
    score = std::max(score, candidate.score);
  }
  return own > 0.0 && rival < kRival * own;
}

PreviewPose PreviewPoseEstimator::estimate(const RgbdFrame& a, const BlockPreview& b,
                                           const Camera& b_camera, const std::vector<Pose>& warm) {
  prepare(a);
  b_ = pyramid(make_view(b, b_camera));
  refined_points_ = points_of(b_[0], kRefinement.stride);
  for (const Pose& b_from_a : warm) {
    Candidate candidate;
    candidate.a_from_b = b_from_a.inverse();
    if (!refine(candidate)) continue;
    judge(candidate);
    PreviewPose pose = finish(candidate, 0.0);
    const double needed = options_.limits.min_evidence + options_.limits.warm_evidence;
    const bool is_accepted = pose.verdict.accepted() && pose.log_odds >= needed;
    if (!is_accepted || !stands_alone(candidate)) continue;
    pose.verdict.needed = static_cast<float>(needed);
    return pose;
  }
  Candidate best_start;
  best_start.a_from_b = Pose::Identity();
  const std::vector<Candidate> found = search(best_start);
  if (found.empty()) {
    PreviewPose none;
    none.verdict = why_nothing(best_start);
    none.searched = true;
    return none;
  }
  double second = 0.0;
  for (const Candidate& other : found) {
    if (differ(other.a_from_b, found[0].a_from_b, kDistinctMetres, kDistinctDegrees))
      second = std::max(second, other.score);
  }
  PreviewPose pose = finish(found[0], second);
  pose.searched = true;
  pose.starts = static_cast<int>(found.size());
  return pose;
}

}  // namespace rprr
