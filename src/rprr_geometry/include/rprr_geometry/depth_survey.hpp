// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// What readings of a depth image look like, from every fourth column and row: enough to see that a
/// sensor is dead or that its unit is not what it is taken for.
struct DepthSurvey {
  double share_read = 0.0;  // of the pixels, that have a reading
  double median = 0.0;      // of the readings [m]; 0: there are none

  /// Depth cameras of the kinds that RPRR is for see 0.2 m to 10 m.
  bool is_implausible() const { return median > kFarthest || (median > 0.0 && median < kNearest); }

  static constexpr double kNearest = 0.15;  // [m]
  static constexpr double kFarthest = 10.0;
};

DepthSurvey survey_depth(const DepthFrame& frame);

/// Share of the readings of a 32FC1 image [m] that are farther than limit, from every fourth column
/// and row.
double share_beyond(const cv::Mat& metres, double limit);

}  // namespace rprr
