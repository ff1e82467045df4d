// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "rprr_geometry/se3.hpp"
#include "rprr_pose/preview_view.hpp"

namespace rprr {

/// The points of a view that take part in an alignment: those with depth, every stride-th cell in a
/// staggered pattern. One entry a point.
struct MovingPoints {
  std::vector<float> x, y, z;   // optical frame of the moving view [m]
  std::vector<float> variance;  // of z, metres^2
  std::vector<float> luma;
  std::vector<std::uint16_t> tile;  // which patch of the view the point is in

  std::size_t size() const { return z.size(); }
};
/// Tiles are squares of kTileCells cells a side, numbered row by row.
constexpr int kTileCells = 10;
MovingPoints points_of(const PreviewView& view, int stride);

/// What the moving view's points are aligned to: cells of the fixed view, with, where it is known,
/// the fixed camera's own depth and luma at a finer grain.
struct FixedView {
  const PreviewView* cells = nullptr;
  /// Finer images of the same field of view, or empty: depth in metres (CV_32FC1, 0 = none) and
  /// luma (CV_32FC1) with their cameras. Luma must be as smooth as a cell.
  cv::Mat metres;
  Camera metres_camera;
  cv::Mat luma;
  Camera luma_camera;
};

struct AlignmentOptions {
  int iterations = 8;
  float gate = 0.3f;        // correspondences further apart do not count in the first step [m]
  float last_gate = 0.08f;  // in the last one
  // Luma residuals, grey levels. Their spread is taken from the residuals themselves, within these
  // bounds: coding and noise below, views that are not aligned yet above.
  float least_luma_sigma = 5.0f;
  float most_luma_sigma = 20.0f;
  bool scatter = false;  // also fill in AlignmentSums::scatter
};

/// Sums of the last iteration at its pose.
struct AlignmentSums {
  Matrix6 information = Matrix6::Zero();  // of the left perturbation of the moving-to-fixed motion
  Matrix6 geometric = Matrix6::Zero();    // the part of it that depth alone gives
  double chi2_geometry = 0.0;             // sum of squared residuals over their variance
  double chi2_luma = 0.0;
  double luma_sigma = 0.0;  // what chi2_luma is in units of [grey levels]
  /// Sum over tiles of g g^T, g being the tile's gradient at the final pose: what residuals that
  /// neighbours share do to the estimate (a cluster-robust covariance is H^-1 scatter H^-1).
  Matrix6 scatter = Matrix6::Zero();
  int tiles = 0;     // that had residuals
  int geometry = 0;  // residuals of each kind
  int luma = 0;
  // Of the points that took part: how many landed within the gate, clearly before (in seen free
  // space) or behind the fixed surface, and how their luma correlates.
  int points = 0, close = 0, before = 0, behind = 0;
  double correlation = 0.0;

  /// A cheap judgement while there are many candidates, at most 1: how well the views agree where
  /// they meet, and a little how much of them meets.
  double score() const;
};

/// Gauss-Newton on point-to-plane distances (fixed normals) and luma differences (after an affine
/// exposure change that is estimated along), projective correspondences, robust weights.
/// fixed_from_moving maps points of the moving view into the fixed one and is improved in place.
/// False if it was lost.
bool align(const MovingPoints& moving, const FixedView& fixed, const AlignmentOptions& options,
           Pose& fixed_from_moving, AlignmentSums& sums);

/// Covariance of the motion, left perturbation (tx ty tz rx ry rz), from sums with their scatter.
Matrix6 covariance_of(const AlignmentSums& sums);
/// The standard deviation in the worst direction of a block of it.
double worst_sigma(const Eigen::Matrix3d& covariance);

}  // namespace rprr
