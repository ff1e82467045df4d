// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "intersection.hpp"
#include "rprr_geometry/camera.hpp"

namespace rprr {

/// Which solids may be seen in each square of an image: spares every ray the solids elsewhere.
class ScreenTiles {
 public:
  /// Keeps a reference to the solids, which are placed in the camera's optical frame.
  ScreenTiles(const std::vector<PlacedPrimitive>& placed, const Camera& camera);

  /// The first solid on the ray through pixel (u, v), and the ray's parameter there; -1 if none.
  std::pair<int, float> first_hit(int u, int v, const Eigen::Vector3f& ray) const;

 private:
  struct Candidate {
    int index;
    float nearest;  // no point of the solid has less depth
  };

  static constexpr int kSide = 16;  // [px]

  const std::vector<PlacedPrimitive>& placed_;
  int columns_;
  std::vector<std::vector<Candidate>> tiles_;  // each ascending by `nearest`
};

}  // namespace rprr
