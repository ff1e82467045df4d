// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rprr_geometry/camera.hpp"

namespace rprr {

/// A camera's field of view as a pyramid, for pictures: ends of lines, two by two, metres in its
/// optical frame. Four edges from the camera to the image's corners at depth `length`, the image's
/// rim, and a roof above its upper side.
std::vector<Eigen::Vector3d> frustum_lines(const Camera& camera, double length);

}  // namespace rprr
