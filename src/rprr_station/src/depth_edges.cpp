// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/depth_edges.hpp"

#include <algorithm>
#include <cstddef>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

constexpr std::uint16_t kNone = 65535;  // as the nearest depth

// Nearest and farthest depth up to `margin` pixels left and right. padded: counts with `margin`
// zeros at either end.
void along_row(const std::uint16_t* padded, int width, int margin, std::uint16_t* nearest,
               std::uint16_t* farthest) {
  std::fill(nearest, nearest + width, kNone);
  std::fill(farthest, farthest + width, std::uint16_t{0});
  for (int k = 0; k <= 2 * margin; ++k) {
    for (int u = 0; u < width; ++u) {
      const std::uint16_t depth = padded[u + k];
      farthest[u] = std::max(farthest[u], depth);
      // No depth is 0, which becomes the farthest of all.
      const auto shifted = static_cast<std::uint16_t>(depth - 1);
      nearest[u] = std::min(nearest[u], shifted);
    }
  }
}

}  // namespace

DepthEdges::DepthEdges(int margin, float jump) : margin_(std::clamp(margin, 0, 8)), jump_(jump) {
}

void DepthEdges::clear(cv::Mat& counts, const cv::Mat& predicted) {
  if (margin_ == 0) return;
  const int width = counts.cols;
  nearest_.create(counts.size(), CV_16UC1);
  farthest_.create(counts.size(), CV_16UC1);
  padded_.assign(static_cast<std::size_t>(width + 2 * margin_), 0);
  for (int v = 0; v < counts.rows; ++v) {
    const auto* from = counts.ptr<std::uint16_t>(v);
    std::copy(from, from + width, padded_.begin() + margin_);
    along_row(padded_.data(), width, margin_, nearest_.ptr<std::uint16_t>(v),
              farthest_.ptr<std::uint16_t>(v));
  }
  near_.resize(static_cast<std::size_t>(width));
  far_.resize(static_cast<std::size_t>(width));
  const float ratio = 1.0f + jump_;
  for (int v = 0; v < counts.rows; ++v) {
    std::fill(near_.begin(), near_.end(), kNone);
    std::fill(far_.begin(), far_.end(), std::uint16_t{0});
    const int last = std::min(v + margin_, counts.rows - 1);
    for (int row = std::max(v - margin_, 0); row <= last; ++row) {
      const auto* nearest = nearest_.ptr<std::uint16_t>(row);
      const auto* farthest = farthest_.ptr<std::uint16_t>(row);
      for (std::size_t u = 0; u < near_.size(); ++u) {
        near_[u] = std::min(near_[u], nearest[u]);
        far_[u] = std::max(far_[u], farthest[u]);
      }
    }
    auto* depth = counts.ptr<std::uint16_t>(v);
    const auto* flag = predicted.ptr<std::uint8_t>(v);
    for (std::size_t u = 0; u < near_.size(); ++u) {
      const float nearest = static_cast<float>(near_[u]) + 1.0f;
      const bool edge = static_cast<float>(far_[u]) > ratio * nearest;
      depth[u] = edge && flag[u] != 0 ? std::uint16_t{0} : depth[u];
    }
  }
}

}  // namespace rprr
