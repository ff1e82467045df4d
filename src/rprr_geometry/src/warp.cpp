// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/warp.hpp"

#include "rprr_geometry/pixel_map.hpp"

namespace rprr {

void warp_depth(const DepthFrame& source, const Camera& source_camera, const Camera& target_camera,
                const Pose& motion, WarpedDepth& out) {
  out.metres.create(target_camera.height, target_camera.width, CV_32FC1);
  out.source.create(target_camera.height, target_camera.width, CV_32SC1);
  out.metres.setTo(0);
  out.source.setTo(-1);

  const PixelMap to_target(source_camera, target_camera, motion, source.unit);
  const Eigen::Vector3f& offset = to_target.offset;
  const Eigen::Vector3f& step = to_target.step;
  const auto width = static_cast<float>(target_camera.width);
  const auto height = static_cast<float>(target_camera.height);
  auto* const depth_out = out.metres.ptr<float>();
  auto* const source_out = out.source.ptr<int>();

  for (int v = 0; v < source.height(); ++v) {
    const auto* counts = source.counts.ptr<std::uint16_t>(v);
    const Eigen::Vector3f row_start = to_target.row(v);
    const int row_index = v * source.width();
    for (int u = 0; u < source.width(); ++u) {
      if (counts[u] == 0) continue;
      const auto z = static_cast<float>(counts[u]);
      const auto column = static_cast<float>(u);
      const float w = z * (row_start.z() + column * step.z()) + offset.z();
      if (w < kNearestDepth) continue;
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
