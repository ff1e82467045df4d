// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rprr_geometry/camera.hpp"

namespace rprr {

/// A camera in float32, for inner loops.
struct Pinhole {
  float fx = 0, fy = 0, cx = 0, cy = 0;
  int width = 0, height = 0;

  Pinhole() = default;
  explicit Pinhole(const Camera& camera)
      : fx(static_cast<float>(camera.fx)),
        fy(static_cast<float>(camera.fy)),
        cx(static_cast<float>(camera.cx)),
        cy(static_cast<float>(camera.cy)),
        width(camera.width),
        height(camera.height) {}

  /// Index of the pixel nearest to pixel coordinates (u, v), or -1 outside and for what is no
  /// number: compared before they are converted, since a peer's camera may throw points anywhere.
  int index(float u, float v) const {
    u += 0.5f;
    v += 0.5f;
    const bool inside =
        u >= 0.0f && v >= 0.0f && u < static_cast<float>(width) && v < static_cast<float>(height);
    return inside ? static_cast<int>(v) * width + static_cast<int>(u) : -1;
  }
  /// Index of the pixel that the ray (x, y, 1) meets.
  int index_of_ray(float x, float y) const { return index(fx * x + cx, fy * y + cy); }
};

}  // namespace rprr
