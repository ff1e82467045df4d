// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/raw_disparity.hpp"

#include <cmath>

namespace rprr {
namespace {

constexpr double kFarthest = 10.0;  // m: a step of the disparity is 0.3 m there

}  // namespace

DisparityTable::DisparityTable(const DisparityModel& model) : table_(kDisparityValues, 0) {
  for (int raw = 0; raw < kNoDisparity; ++raw) {
    const double inverse = model.offset - model.step * raw;
    if (!(inverse >= 1.0 / kFarthest)) continue;
    const double millimetres = std::round(1000.0 / inverse);
    if (millimetres >= 1.0) {
      table_[static_cast<std::size_t>(raw)] = static_cast<std::uint16_t>(millimetres);
    }
  }
}

DepthFrame DisparityTable::depth(const cv::Mat& raw) const {
  DepthFrame frame{cv::Mat(raw.size(), CV_16UC1), 0.001};
  for (int v = 0; v < raw.rows; ++v) {
    const auto* in = raw.ptr<std::uint16_t>(v);
    auto* out = frame.counts.ptr<std::uint16_t>(v);
    for (int u = 0; u < raw.cols; ++u) out[u] = millimetres(in[u]);
  }
  return frame;
}

std::uint16_t disparity_of(double metres, const DisparityModel& model) {
  if (!(metres > 0.0)) return kNoDisparity;
  const double raw = std::round((model.offset - 1.0 / metres) / model.step);
  return raw >= 0.0 && raw < kNoDisparity ? static_cast<std::uint16_t>(raw) : kNoDisparity;
}

}  // namespace rprr
