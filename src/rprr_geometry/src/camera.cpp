// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/camera.hpp"

#include <cmath>

namespace rprr {

bool Camera::valid() const {
  const bool sizes = width > 0 && height > 0 && width <= kMaxImageSide && height <= kMaxImageSide;
  const bool numbers =
      std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) && std::isfinite(cy);
  return sizes && numbers && fx > 1e-3 && fy > 1e-3 && fx < 1e7 && fy < 1e7 && std::abs(cx) < 1e6 &&
         std::abs(cy) < 1e6;
}

}  // namespace rprr
