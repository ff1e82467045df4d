// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/warp.hpp"

#include <algorithm>

namespace rprr {
namespace {

// Below this depth a point is too close to the target camera's plane to be projected.
constexpr float kNearest = 0.05f;

}  // namespace

void warp_depth(const DepthFrame& source, const Camera& source_camera, const Camera& target_camera,
                const Pose& motion, WarpedDepth& out) {
  out.metres.create(target_camera.height, target_camera.width, CV_32FC1);
  out.source.create(target_camera.height, target_camera.width, CV_32SC1);
  out.metres.setTo(0);
  out.source.setTo(-1);

  // Along a row, K_b M_ab (z K_a^-1 [u v 1] , 1) is z (row_start + u step) + offset: homogeneous
  // target pixel, third component the depth in b.
  Eigen::Matrix3d target_k;
  target_k << target_camera.fx, 0, target_camera.cx, 0, target_camera.fy, target_camera.cy, 0, 0, 1;
  Eigen::Matrix3d source_k_inverse;
  source_k_inverse << 1 / source_camera.fx, 0, -source_camera.cx / source_camera.fx, 0,
      1 / source_camera.fy, -source_camera.cy / source_camera.fy, 0, 0, 1;
  const Eigen::Matrix3d map = target_k * motion.linear() * source_k_inverse * source.unit;
  const Eigen::Vector3f offset = (target_k * motion.translation()).cast<float>();
  const Eigen::Vector3f step = map.col(0).cast<float>();
  const auto width = static_cast<float>(target_camera.width);
  const auto height = static_cast<float>(target_camera.height);
  auto* const depth_out = out.metres.ptr<float>();
  auto* const source_out = out.source.ptr<int>();

  for (int v = 0; v < source.height(); ++v) {
    const auto* counts = source.counts.ptr<std::uint16_t>(v);
    const Eigen::Vector3f row_start = (map.col(1) * v + map.col(2)).cast<float>();
    const int row_index = v * source.width();
    for (int u = 0; u < source.width(); ++u) {
      if (counts[u] == 0) continue;
      const auto z = static_cast<float>(counts[u]);
      const auto column = static_cast<float>(u);
      const float w = z * (row_start.z() + column * step.z()) + offset.z();
      if (w < kNearest) continue;
      const float inverse = 1.0f / w;
      const float x = (z * (row_start.x() + column * step.x()) + offset.x()) * inverse + 0.5f;
      const float y = (z * (row_start.y() + column * step.y()) + offset.y()) * inverse + 0.5f;
      if (!(x >= 0.0f && y >= 0.0f && x < width && y < height)) continue;
      const int at = static_cast<int>(y) * target_camera.width + static_cast<int>(x);
      if (depth_out[at] == 0.0f || w < depth_out[at]) {
        depth_out[at] = w;
        source_out[at] = row_index + u;
      }
    }
  }
}

}  // namespace rprr
