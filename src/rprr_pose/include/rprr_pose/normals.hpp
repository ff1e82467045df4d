// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// Surface normal at a pixel, unit length, towards the camera, in the optical frame. A plane is
/// linear in inverse depth over the image, and there a Kinect's noise is even, so the plane is
/// fitted to q = 1/z over a 9x9 window (every second pixel), leaving out what lies across a depth
/// edge. Nothing where the pixel is invalid or too few neighbours belong to its surface.
std::optional<Eigen::Vector3d> normal_at(const DepthFrame& frame, const Camera& camera, int u,
                                         int v);

}  // namespace rprr
