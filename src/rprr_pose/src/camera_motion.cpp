// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/camera_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "rprr_pose/frame_views.hpp"
#include "rprr_pose/pose_evidence.hpp"
#include "rprr_pose/preview_agreement.hpp"

namespace rprr {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kLeastSide = 32;           // [px]
constexpr double kFewestReadings = 0.1;  // of a view's cells
// What a still camera's frames may seem to have moved, beyond its noise in this alignment.
constexpr double kStillMetres = 0.01;
constexpr double kStillRadians = 0.3 * kDegree;
constexpr double kSigmas = 3.0;
// Less sure than this the frames do not tell.
constexpr double kWorstMetres = 0.03;
constexpr double kWorstRadians = 1.0 * kDegree;
// What a motion must explain of what both frames show.
constexpr double kFewestConsistent = 0.8;
constexpr double kMostViolating = 0.06;
constexpr double kMargin = 0.3;
constexpr double kLeastEvidence = 1.0;  // log odds
constexpr double kLeastTexture = 4.0;   // [grey levels] with less luma does not tell
constexpr double kLeastOverlap = 0.2;
constexpr double kTurn = 9.0 * kDegree;  // between starts

// Both frames at block resolution and coarser; the earlier is the fixed one.
struct Views {
  std::vector<PreviewView> earlier, later;
  FixedView fine;
};

struct Found {
  Pose later_to_earlier = Pose::Identity();
  AlignmentSums sums;
  Agreement forth, back;
};

bool usable(const RgbdFrame& frame) {
  const cv::Mat& counts = frame.depth.counts;
  return counts.type() == CV_16UC1 && std::min(counts.cols, counts.rows) >= kLeastSide &&
         counts.cols == frame.camera.width && counts.rows == frame.camera.height &&
         frame.depth.unit > 0.0;
}

std::vector<PreviewView> views_of(const RgbdFrame& frame) {
  return pyramid(make_view(make_preview(frame.depth, frame.bgr), frame.camera));
}

bool has_depth(const PreviewView& view) {
  return view.valid_count() >= kFewestReadings * static_cast<double>(view.size());
}

// From the coarsest view to the finest, then to all of the earlier frame's depth and luma.
bool follow(const Views& views, Found& found) {
  const std::size_t levels = std::min(views.earlier.size(), views.later.size());
  for (std::size_t level = levels; level-- > 0;) {
    FixedView fixed;
    fixed.cells = &views.earlier[level];
    const AlignmentOptions options{6, level + 1 == levels ? 0.5f : 0.25f, 0.12f};
    if (!align(points_of(views.later[level], 1), fixed, options, found.later_to_earlier,
               found.sums)) {
      return false;
    }
  }
  FixedView fixed = views.fine;
  fixed.cells = &views.earlier[0];
  AlignmentOptions options{8, 0.12f, 0.05f};
  options.scatter = true;
  return align(points_of(views.later[0], 2), fixed, options, found.later_to_earlier, found.sums);
}

double overlap(const Found& found) {
  return std::min(found.forth.overlap(), found.back.overlap());
}

// The evidence is that of poses between two robots. There is no rival to hold this motion against:
// that it was found near where the camera was stands for the margin. Without texture, or colour at
// all, depth has to do.
bool explains(const Found& found) {
  if (overlap(found) < kLeastOverlap) return false;
  const PoseEvidence evidence = evidence_of(found.forth, found.back, kMargin);
  const double consistent = std::min(found.forth.of_overlap(found.forth.consistent),
                                     found.back.of_overlap(found.back.consistent));
  if (consistent < kFewestConsistent || evidence.violating > kMostViolating) return false;
  const bool flat = std::min(found.forth.texture, found.back.texture) < kLeastTexture;
  return flat || log_odds(evidence) >= kLeastEvidence;
}

bool try_from(const Pose& start, const Views& views, Found& found) {
  found.later_to_earlier = start;
  if (!follow(views, found)) return false;
  found.forth = agreement(views.later[0], views.earlier[0], found.later_to_earlier);
  found.back = agreement(views.earlier[0], views.later[0], found.later_to_earlier.inverse());
  return explains(found);
}

// The turn, out of a few, from which the coarsest views agree best: robots turn faster than they
// drive.
Pose best_turn(const Views& views) {
  FixedView fixed;
  fixed.cells = &views.earlier.back();
  const MovingPoints points = points_of(views.later.back(), 1);
  Pose best = Pose::Identity();
  double best_score = 0.0;
  for (const double pitch : {-kTurn, 0.0, kTurn}) {
    for (const double yaw : {-2 * kTurn, -kTurn, 0.0, kTurn, 2 * kTurn}) {
      Twist turn = Twist::Zero();
      turn[3] = pitch;
      turn[4] = yaw;
      Pose pose = exp_se3(turn);
      AlignmentSums sums;
      if (!align(points, fixed, {8, 0.5f, 0.2f}, pose, sums) || sums.score() <= best_score)
        continue;
      best_score = sums.score();
      best = pose;
    }
  }
  return best;
}

CameraMotion told_by(const Found& found) {
  CameraMotion out;
  const Matrix6 covariance = covariance_of(found.sums);
  const double sigma_metres = worst_sigma(covariance.topLeftCorner<3, 3>());
  const double sigma_radians = worst_sigma(covariance.bottomRightCorner<3, 3>());
  if (sigma_metres > kWorstMetres || sigma_radians > kWorstRadians) return out;
  out.later_from_earlier = found.later_to_earlier.inverse();
  out.metres = found.later_to_earlier.translation().norm();
  out.radians = rotation_angle(out.later_from_earlier.linear());
  out.overlap = overlap(found);
  const bool still = out.metres < kStillMetres + kSigmas * sigma_metres &&
                     out.radians < kStillRadians + kSigmas * sigma_radians;
  out.outcome = still ? CameraMotion::Outcome::kStill : CameraMotion::Outcome::kMoved;
  return out;
}

}  // namespace

CameraMotion camera_motion(const RgbdFrame& earlier, const RgbdFrame& later) {
  CameraMotion out;
  if (!usable(earlier) || !usable(later)) return out;
  const Views views{views_of(earlier), views_of(later), fine_view(earlier)};
  if (!has_depth(views.earlier[0]) || !has_depth(views.later[0])) return out;
  Found found;
  if (try_from(Pose::Identity(), views, found) || try_from(best_turn(views), views, found)) {
    return told_by(found);
  }
  out.outcome = CameraMotion::Outcome::kSceneChanged;
  return out;
}

}  // namespace rprr
