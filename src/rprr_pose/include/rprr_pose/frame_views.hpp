// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_pose/preview_alignment.hpp"

namespace rprr {

/// The view and halves of it, one of the other, down to about 20 cells a row; at least two levels.
std::vector<PreviewView> pyramid(PreviewView view);

/// The frame's own depth and luma, for a view of it to be refined by: all of a FixedView but its
/// cells. Without colour of the frame's size luma is left to the cells.
FixedView fine_view(const RgbdFrame& frame);

}  // namespace rprr
