// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rprr_synthetic/synthetic_scene.hpp"

namespace rprr {

/// A place on a surface, laid flat: u to the right, v up, metres.
struct SurfacePoint {
  float u = 0.0f;
  float v = 0.0f;
  float half_width = 1.0f;   // of the face
  float half_height = 1.0f;  // [m]
  float footprint = 0.0f;    // what one pixel covers; finer structure fades out
  std::uint32_t face = 0;    // tells a solid's faces apart
};

/// Linear BGR reflectance of a material there.
Eigen::Vector3f albedo(const Material& material, const SurfacePoint& at);

}  // namespace rprr
