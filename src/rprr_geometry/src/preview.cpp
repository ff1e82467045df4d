// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/preview.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rprr {
namespace {

const cv::Vec3b kNoColour(128, 128, 128);
constexpr int kFewestReadings = 16;    // of the 64 of a block
constexpr int kFewestSampled = 3;      // of the 16 that the median looks at
constexpr float kSameSurface = 0.03f;  // relative distance of depths from the block's median

struct Sum {
  float q = 0.0f;
  int count = 0;
};

// Median of every second pixel in both directions.
std::uint16_t median_of(const cv::Mat& counts, const cv::Rect& rect) {
  std::array<std::uint16_t, 16> values;
  std::size_t n = 0;
  for (int v = rect.y; v < rect.y + rect.height; v += 2) {
    const auto* row = counts.ptr<std::uint16_t>(v);
    for (int u = rect.x + (v / 2) % 2; u < rect.x + rect.width; u += 2) {
      if (row[u] != 0) values[n++] = row[u];
    }
  }
  if (n < kFewestSampled) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(n / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(n));
  return *middle;
}

Sum inverse_around(const cv::Mat& counts, const cv::Rect& rect, std::uint16_t median) {
  Sum sum;
  const auto centre = static_cast<float>(median);
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    const auto* row = counts.ptr<std::uint16_t>(v);
    for (int u = rect.x; u < rect.x + rect.width; ++u) {
      const auto value = static_cast<float>(row[u]);
      if (std::abs(value - centre) > kSameSurface * centre) continue;
      sum.q += 1.0f / value;
      ++sum.count;
    }
  }
  return sum;
}

cv::Vec3b mean_colour(const cv::Mat& bgr, const cv::Rect& rect) {
  std::array<int, 3> sum{};
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    const auto* row = bgr.ptr<std::uint8_t>(v) + 3 * rect.x;
    for (int u = 0; u < 3 * rect.width; u += 3) {
      sum[0] += row[u];
      sum[1] += row[u + 1];
      sum[2] += row[u + 2];
    }
  }
  const int n = rect.area();
  return {static_cast<std::uint8_t>((sum[0] + n / 2) / n),
          static_cast<std::uint8_t>((sum[1] + n / 2) / n),
          static_cast<std::uint8_t>((sum[2] + n / 2) / n)};
}

}  // namespace

BlockPreview make_preview(const DepthFrame& depth, const cv::Mat& bgr, double step) {
  BlockPreview preview;
  preview.grid = BlockGrid(depth.width(), depth.height());
  preview.step = static_cast<double>(static_cast<float>(step));
  preview.inverse_depth.create(preview.grid.rows, preview.grid.columns, CV_16UC1);
  preview.bgr.create(preview.grid.rows, preview.grid.columns, CV_8UC3);
  const bool has_colour = bgr.type() == CV_8UC3 && bgr.size() == depth.counts.size();
  for (int block = 0; block < preview.grid.count(); ++block) {
    const cv::Rect rect = preview.grid.rect(block);
    auto& q = preview.inverse_depth.ptr<std::uint16_t>()[block];
    q = 0;
    const std::uint16_t median = median_of(depth.counts, rect);
    if (median != 0) {
      const Sum sum = inverse_around(depth.counts, rect, median);
      if (sum.count * 64 >= kFewestReadings * rect.area()) {
        const double mean = sum.q / static_cast<float>(sum.count) / depth.unit;
        q = static_cast<std::uint16_t>(std::clamp(std::lround(mean / preview.step), 1L, 65535L));
      }
    }
    preview.bgr.ptr<cv::Vec3b>()[block] = has_colour ? mean_colour(bgr, rect) : kNoColour;
  }
  return preview;
}

std::vector<PreviewPoint> preview_points(const BlockPreview& preview, const Camera& camera) {
  std::vector<PreviewPoint> points;
  const BlockGrid& grid = preview.grid;
  if (camera.width != grid.width || camera.height != grid.height) return points;
  constexpr double kCentre = 0.5 * (kBlockSide - 1);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!preview.valid(column, row)) continue;
      const Eigen::Vector3d point = camera.unproject(
          kBlockSide * column + kCentre, kBlockSide * row + kCentre, 1.0 / preview.q(column, row));
      points.push_back({point.cast<float>(), preview.bgr.at<cv::Vec3b>(row, column)});
    }
  }
  return points;
}

}  // namespace rprr
