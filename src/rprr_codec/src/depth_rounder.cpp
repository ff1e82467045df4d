// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/depth_rounder.hpp"

#include <algorithm>
#include <cmath>

namespace rprr {
namespace {

constexpr int kCounts = 65536;

}  // namespace

const DepthFrame& DepthRounder::round(const DepthFrame& depth, double step) {
  make_table(depth.unit, step);
  rounded_.unit = depth.unit;
  rounded_.counts.create(depth.counts.size(), CV_16UC1);
  for (int v = 0; v < depth.counts.rows; ++v) {
    const auto* from = depth.counts.ptr<std::uint16_t>(v);
    auto* to = rounded_.counts.ptr<std::uint16_t>(v);
    for (int u = 0; u < depth.counts.cols; ++u) to[u] = table_[from[u]];
  }
  return rounded_;
}

void DepthRounder::make_table(double unit, double step) {
  if (!table_.empty() && unit == unit_ && step == step_) return;
  unit_ = unit;
  step_ = step;
  table_.resize(kCounts);
  table_[0] = 0;
  for (int count = 1; count < kCounts; ++count) {
    const double steps = std::max(1.0, std::round(1.0 / (count * unit * step)));
    const double rounded = std::round(1.0 / (steps * step * unit));
    // Beyond the first step lies all that is far: it stays as it is.
    const bool far = count * unit * step > 1.0 || rounded > kCounts - 1;
    table_[static_cast<std::size_t>(count)] =
        static_cast<std::uint16_t>(far ? count : std::max(1.0, rounded));
  }
}

}  // namespace rprr
