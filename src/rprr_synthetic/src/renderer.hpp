// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "intersection.hpp"
#include "rprr_synthetic/synthetic_scene.hpp"
#include "screen_tiles.hpp"

namespace rprr {

/// One view of a scene.
class Renderer {
 public:
  Renderer(const Scene& scene, const Camera& camera, const Pose& world_from_camera);

  ExactView render() const;

 private:
  struct Hit {
    int primitive = -1;  // none
    float metres = 0.0f;
    float infrared = 0.0f;
    Eigen::Vector3f radiance = Eigen::Vector3f::Zero();
  };

  /// What the ray (du, dv) beside the centre of pixel (u, v) meets; less than a pixel beside.
  Hit trace(int u, int v, double du, double dv) const;
  /// Means over four rays where a pixel's neighbours show another solid.
  void smooth_edges(const cv::Mat& primitives, cv::Mat& radiance) const;

  const Scene& scene_;
  const Camera& camera_;
  Eigen::Matrix3f world_turn_;
  Eigen::Vector3f eye_;
  std::vector<PlacedPrimitive> placed_;
  ScreenTiles tiles_;
};

}  // namespace rprr
