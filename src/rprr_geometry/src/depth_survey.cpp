// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/depth_survey.hpp"

#include <algorithm>
#include <vector>

namespace rprr {
namespace {

constexpr int kStride = 4;

}  // namespace

DepthSurvey survey_depth(const DepthFrame& frame) {
  std::vector<std::uint16_t> readings;
  std::size_t looked_at = 0;
  for (int v = 0; v < frame.height(); v += kStride) {
    const auto* row = frame.counts.ptr<std::uint16_t>(v);
    for (int u = 0; u < frame.width(); u += kStride) {
      ++looked_at;
      if (row[u] != 0) readings.push_back(row[u]);
    }
  }
  DepthSurvey survey;
  if (readings.empty()) return survey;
  const auto middle = readings.begin() + static_cast<std::ptrdiff_t>(readings.size() / 2);
  std::nth_element(readings.begin(), middle, readings.end());
  survey.share_read = static_cast<double>(readings.size()) / static_cast<double>(looked_at);
  survey.median = *middle * frame.unit;
  return survey;
}

double share_beyond(const cv::Mat& metres, double limit) {
  std::size_t readings = 0;
  std::size_t beyond = 0;
  for (int v = 0; v < metres.rows; v += kStride) {
    const auto* row = metres.ptr<float>(v);
    for (int u = 0; u < metres.cols; u += kStride) {
      if (!DepthTraits<float>::valid(row[u])) continue;
      ++readings;
      if (static_cast<double>(row[u]) > limit) ++beyond;
    }
  }
  return readings == 0 ? 0.0 : static_cast<double>(beyond) / static_cast<double>(readings);
}

}  // namespace rprr
