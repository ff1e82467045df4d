// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/validation.hpp"

#include <algorithm>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/pixel_map.hpp"

namespace rprr {
namespace {

// Flags the valid pixels of a row that leave the target's image. Multiplied out by the depth in the
// target, so that the loop has neither division nor branch and the compiler can vectorise it.
void flag_outside(const std::uint16_t* counts, int width, const Eigen::Vector3f& row_start,
                  const Eigen::Vector3f& step, const Eigen::Vector3f& offset, const Camera& target,
                  std::uint8_t* outside) {
  const auto right = static_cast<float>(target.width);
  const auto bottom = static_cast<float>(target.height);
  const float sx = row_start.x();
  const float sy = row_start.y();
  const float sz = row_start.z();
  const float dx = step.x();
  const float dy = step.y();
  const float dz = step.z();
  const float ox = offset.x();
  const float oy = offset.y();
  const float oz = offset.z();
  for (int u = 0; u < width; ++u) {
    const auto z = static_cast<float>(counts[u]);
    const auto column = static_cast<float>(u);
    const float w = z * (sz + column * dz) + oz;
    const float x = z * (sx + column * dx) + ox + 0.5f * w;
    const float y = z * (sy + column * dy) + oy + 0.5f * w;
    const int inside = static_cast<int>(w >= kNearestDepth) & static_cast<int>(x >= 0.0f) &
                       static_cast<int>(y >= 0.0f) & static_cast<int>(x < right * w) &
                       static_cast<int>(y < bottom * w);
    outside[u] = static_cast<std::uint8_t>(static_cast<int>(counts[u] != 0) & (inside ^ 1));
  }
}

}  // namespace

BlockMask Validator::validate(const DepthFrame& b, const Camera& b_camera, const Camera& a_camera,
                              const Pose& b_from_a) {
  const BlockGrid grid(b_camera.width, b_camera.height);
  BlockMask mask(grid);
  if (b.empty() || b.width() != b_camera.width || b.height() != b_camera.height) return mask;

  const PixelMap to_a(b_camera, a_camera, b_from_a.inverse(), b.unit);
  outside_.resize(static_cast<std::size_t>(grid.columns) * kBlockSide);
  std::fill(outside_.begin(), outside_.end(), std::uint8_t{0});
  for (int block_row = 0; block_row < grid.rows; ++block_row) {
    outside_in_block_.assign(static_cast<std::size_t>(grid.columns), 0);
    const int end = std::min((block_row + 1) * kBlockSide, grid.height);
    for (int v = block_row * kBlockSide; v < end; ++v) {
      flag_outside(b.counts.ptr<std::uint16_t>(v), grid.width, to_a.row(v), to_a.step, to_a.offset,
                   a_camera, outside_.data());
      const std::uint8_t* flags = outside_.data();
      for (int& outside : outside_in_block_) {
        for (int i = 0; i < kBlockSide; ++i) outside += *flags++;
      }
    }
    for (int column = 0; column < grid.columns; ++column) {
      const int outside = outside_in_block_[static_cast<std::size_t>(column)];
      if (outside >= std::max(options_.min_pixels, 1)) mask.set(grid.index(column, block_row));
    }
  }
  return mask;
}

}  // namespace rprr
