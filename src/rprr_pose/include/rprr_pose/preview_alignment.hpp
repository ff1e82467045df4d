// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/se3.hpp"
#include "rprr_pose/preview_view.hpp"

namespace rprr {

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
  int stride = 1;           // every how many-th cell of the moving view takes part
  float gate = 0.3f;        // metres: correspondences further apart do not count, in the first step
  float last_gate = 0.08f;  // in the last one
  float luma_sigma = 12.0f;  // grey levels: noise, coding and what affine exposure does not explain
};

/// Sums of the last iteration at its pose.
struct AlignmentSums {
  Matrix6 information = Matrix6::Zero();  // of the left perturbation of the moving-to-fixed motion
  Matrix6 geometric = Matrix6::Zero();    // the part of it that depth alone gives
  double chi2_geometry = 0.0;             // sum of squared residuals over their variance
  double chi2_luma = 0.0;
  int geometry = 0;  // residuals of each kind
  int luma = 0;
  // Of the cells that took part: how many had depth, landed within the gate, clearly before (in
  // seen free space) or behind the fixed surface, and how their luma correlates.
  int cells = 0, close = 0, before = 0, behind = 0;
  double correlation = 0.0;

  /// A cheap judgement while there are many candidates, at most 1.
  double score() const {
    if (cells == 0) return 0.0;
    const double agreement = (close - 2.0 * before - 0.5 * behind) / cells;
    return agreement > 0.0 && correlation > 0.0 ? agreement * correlation : 0.0;
  }
};

/// Gauss-Newton on point-to-plane distances (fixed normals) and luma differences (after an affine
/// exposure change that is estimated along), projective correspondences, robust weights. motion
/// maps points of the moving view into the fixed one and is improved in place. False if it was
/// lost.
bool align(const PreviewView& moving, const FixedView& fixed, const AlignmentOptions& options,
           Pose& motion, AlignmentSums& sums);

}  // namespace rprr
