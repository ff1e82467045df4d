// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/depth_edges.hpp"

#include <algorithm>
#include <cstddef>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

// Depths as signed numbers in the same order, of which every processor has a minimum and a maximum
// of many at once.
constexpr int kSign = 0x8000;
constexpr std::int16_t kLeast = -kSign;
constexpr std::int16_t kMost = kSign - 1;

std::int16_t as_signed(int depth) {
  return static_cast<std::int16_t>(depth - kSign);
}
float as_depth(std::int16_t number) {
  return static_cast<float>(static_cast<int>(number) + kSign);
}

// For the nearest depth: no depth is the farthest of all. One count less than it is.
std::int16_t as_nearest(std::uint16_t depth) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(depth - 1) ^ kSign);
}

const std::int16_t& smaller(const std::int16_t& a, const std::int16_t& b) {
  return std::min(a, b);
}
const std::int16_t& larger(const std::int16_t& a, const std::int16_t& b) {
  return std::max(a, b);
}

template <const std::int16_t& (*kOf)(const std::int16_t&, const std::int16_t&)>
void combine(const std::int16_t* __restrict values, std::ptrdiff_t away, int count,
             std::int16_t* __restrict out) {
  for (int u = 0; u < count; ++u) out[u] = kOf(values[u], values[u + away]);
}

// Finds the least or the largest of every `window` values that follow each other. A window of twice
// the size comes from two windows that touch, and the last one from two that overlap. `values`
// holds count + window - 1 values and is overwritten; `spare` is as long.
template <const std::int16_t& (*kOf)(const std::int16_t&, const std::int16_t&)>
void along_row(std::int16_t* values, std::int16_t* spare, int count, int window,
               std::int16_t* out) {
  int done = 1;
  for (; 2 * done < window; done *= 2) {
    combine<kOf>(values, done, count + window - 2 * done, spare);
    std::swap(values, spare);
  }
  combine<kOf>(values, window - done, count, out);
}

}  // namespace

DepthEdges::DepthEdges(int margin, float jump) : margin_(std::clamp(margin, 0, 8)), jump_(jump) {
}

void DepthEdges::clear(cv::Mat& counts, const cv::Mat& predicted) {
  if (margin_ == 0) return;
  const int width = counts.cols;
  const int window = 2 * margin_ + 1;
  nearest_.create(counts.size(), CV_16SC1);
  farthest_.create(counts.size(), CV_16SC1);
  padded_.resize(static_cast<std::size_t>(width + window));
  spare_.resize(padded_.size());
  for (int v = 0; v < counts.rows; ++v) {
    const auto* from = counts.ptr<std::uint16_t>(v);
    std::fill(padded_.begin(), padded_.end(), kMost);
    std::transform(from, from + width, padded_.begin() + margin_, as_nearest);
    along_row<smaller>(padded_.data(), spare_.data(), width, window, nearest_.ptr<std::int16_t>(v));
    std::fill(padded_.begin(), padded_.end(), kLeast);
    std::transform(from, from + width, padded_.begin() + margin_, as_signed);
    along_row<larger>(padded_.data(), spare_.data(), width, window, farthest_.ptr<std::int16_t>(v));
  }
  near_.resize(static_cast<std::size_t>(width));
  far_.resize(static_cast<std::size_t>(width));
  for (int v = 0; v < counts.rows; ++v) {
    find_range(v);
    clear_row(near_.data(), far_.data(), predicted.ptr<std::uint8_t>(v), width,
              counts.ptr<std::uint16_t>(v));
  }
}

// Nearest and farthest of the window around each pixel of a row.
void DepthEdges::find_range(int v) {
  std::fill(near_.begin(), near_.end(), kMost);
  std::fill(far_.begin(), far_.end(), kLeast);
  const int last = std::min(v + margin_, nearest_.rows - 1);
  for (int row = std::max(v - margin_, 0); row <= last; ++row) {
    const auto* nearest = nearest_.ptr<std::int16_t>(row);
    const auto* farthest = farthest_.ptr<std::int16_t>(row);
    for (std::size_t u = 0; u < near_.size(); ++u) {
      near_[u] = std::min(near_[u], nearest[u]);
      far_[u] = std::max(far_[u], farthest[u]);
    }
  }
}

void DepthEdges::clear_row(const std::int16_t* __restrict near, const std::int16_t* __restrict far,
                           const std::uint8_t* __restrict predicted, int width,
                           std::uint16_t* __restrict depth) const {
  const float ratio = 1.0f + jump_;
  for (int u = 0; u < width; ++u) {
    const int edge = static_cast<int>(as_depth(far[u]) > ratio * (as_depth(near[u]) + 1.0f));
    const int keep = (edge & static_cast<int>(predicted[u] != 0)) - 1;
    depth[u] = static_cast<std::uint16_t>(depth[u] & keep);
  }
}

}  // namespace rprr
