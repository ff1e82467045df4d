// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/se3.hpp"
#include "rprr_pose/preview_view.hpp"

namespace rprr {

/// How two views agree under a pose, one way: every cell of one looked up in the other.
struct Agreement {
  int valid = 0;       // cells of the moving view with depth
  int in_view = 0;     // of those, inside the fixed view and on depth
  int consistent = 0;  // of in_view: on the fixed surface, within noise and one cell
  int violating = 0;   // of in_view: clearly before it, where the fixed camera saw through
  int hidden = 0;      // of in_view: clearly behind it
  double chi2 = 0.0;   // over consistent cells: squared depth difference over its variance, capped
  double correlation = 0.0;        // of luma over the consistent cells, -1 to 1
  double fine_correlation = 0.0;   // of what luma differs from its neighbourhood by
  double chroma_difference = 0.0;  // RMS of colour differences after a common shift, grey levels
  double texture = 0.0;            // standard deviation of the fixed luma over the consistent cells

  /// Share of the moving view that the fixed one shows; 0 if there is nothing to share.
  double overlap() const { return valid > 0 ? static_cast<double>(in_view) / valid : 0.0; }
  /// So many cells as a share of the overlap.
  double of_overlap(double cells) const { return in_view > 0 ? cells / in_view : 0.0; }
};

/// fixed_from_moving maps points of the moving view into the fixed one.
Agreement agreement(const PreviewView& moving, const PreviewView& fixed,
                    const Pose& fixed_from_moving);

}  // namespace rprr
