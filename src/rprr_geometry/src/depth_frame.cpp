// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/depth_frame.hpp"

namespace rprr {
namespace {

std::uint16_t to_counts(double value) {
  const double rounded = std::floor(value + 0.5);
  return rounded >= 1.0 && rounded <= 65535.0 ? static_cast<std::uint16_t>(rounded) : 0;
}

DepthFrame quantise(const cv::Mat& metres, double unit) {
  DepthFrame frame;
  frame.unit = unit;
  frame.counts.create(metres.size(), CV_16UC1);
  const double per_metre = 1.0 / unit;
  for (int v = 0; v < metres.rows; ++v) {
    const auto* in = metres.ptr<float>(v);
    auto* out = frame.counts.ptr<std::uint16_t>(v);
    for (int u = 0; u < metres.cols; ++u) {
      out[u] = DepthTraits<float>::valid(in[u]) ? to_counts(in[u] * per_metre) : 0;
    }
  }
  return frame;
}

}  // namespace

Result<DepthFrame> depth_frame_from_image(const cv::Mat& image, const DepthUnits& units) {
  if (image.empty()) return Error{"depth image is empty"};
  if (!(units.of_counts > 0.0) || !(units.for_metres > 0.0)) {
    return Error{"depth unit is not positive"};
  }
  if (image.type() == CV_16UC1) return DepthFrame{image, units.of_counts};
  if (image.type() != CV_32FC1) return Error{"depth image is neither 16UC1 nor 32FC1"};
  return quantise(image, units.for_metres);
}

cv::Mat to_float_image(const DepthFrame& frame) {
  cv::Mat image(frame.counts.size(), CV_32FC1);
  const auto unit = static_cast<float>(frame.unit);
  for (int v = 0; v < image.rows; ++v) {
    const auto* in = frame.counts.ptr<std::uint16_t>(v);
    auto* out = image.ptr<float>(v);
    for (int u = 0; u < image.cols; ++u) {
      out[u] = in[u] == 0 ? DepthTraits<float>::invalid() : static_cast<float>(in[u]) * unit;
    }
  }
  return image;
}

cv::Mat to_millimetre_image(const DepthFrame& frame) {
  if (frame.unit == 0.001) return frame.counts;
  cv::Mat image(frame.counts.size(), CV_16UC1);
  const double scale = frame.unit * 1000.0;
  for (int v = 0; v < image.rows; ++v) {
    const auto* in = frame.counts.ptr<std::uint16_t>(v);
    auto* out = image.ptr<std::uint16_t>(v);
    for (int u = 0; u < image.cols; ++u) out[u] = to_counts(in[u] * scale);
  }
  return image;
}

}  // namespace rprr
