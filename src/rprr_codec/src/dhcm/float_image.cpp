// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/float_image.hpp"
#include "rprr_wire/bytes.hpp"

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <optional>

namespace rprr::dhcm {
namespace {

// How counts of a grid become numbers: drivers multiply in either precision.
enum Layout : std::uint8_t { kDoubleProduct = 0, kFloatProduct = 1, kHalves = 2 };

constexpr std::uint32_t kQuietNan = 0x7FC00000u;
constexpr std::uint16_t kNanHalf = 0x7FC0u;

std::uint32_t bits_of(float number) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &number, sizeof(bits));
  return bits;
}
float number_of(std::uint32_t bits) {
  float number = 0.0f;
  std::memcpy(&number, &bits, sizeof(number));
  return number;
}

float grid_number(std::uint16_t count, double unit, Layout layout) {
  if (count == 0) return number_of(kQuietNan);
  if (layout == kFloatProduct) return static_cast<float>(count) * static_cast<float>(unit);
  return static_cast<float>(count * unit);
}

// The image as counts, if each of its pixels is what grid_number gives.
std::optional<DepthFrame> on_grid(const cv::Mat& metres, double unit, Layout layout) {
  DepthFrame frame = {cv::Mat(metres.size(), CV_16UC1), unit};
  for (int v = 0; v < metres.rows; ++v) {
    const auto* in = metres.ptr<float>(v);
    auto* out = frame.counts.ptr<std::uint16_t>(v);
    for (int u = 0; u < metres.cols; ++u) {
      const double count = std::nearbyint(in[u] / unit);
      out[u] = count >= 1.0 && count <= 65535.0 ? static_cast<std::uint16_t>(count) : 0;
      if (bits_of(grid_number(out[u], unit, layout)) != bits_of(in[u])) return std::nullopt;
    }
  }
  return frame;
}

// NaN's upper half and 0 change places: what has no reading is 0 in both halves.
std::uint16_t swap_nan(std::uint16_t half) {
  if (half == kNanHalf) return 0;
  return half == 0 ? kNanHalf : half;
}

void split_halves(const cv::Mat& metres, DepthFrame& upper, DepthFrame& lower) {
  upper.counts.create(metres.size(), CV_16UC1);
  lower.counts.create(metres.size(), CV_16UC1);
  for (int v = 0; v < metres.rows; ++v) {
    const auto* in = metres.ptr<float>(v);
    for (int u = 0; u < metres.cols; ++u) {
      const std::uint32_t bits = bits_of(in[u]);
      upper.counts.at<std::uint16_t>(v, u) = swap_nan(static_cast<std::uint16_t>(bits >> 16));
      lower.counts.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(bits);
    }
  }
}

cv::Mat join_halves(const DepthFrame& upper, const DepthFrame& lower) {
  cv::Mat metres(upper.counts.size(), CV_32FC1);
  for (int v = 0; v < metres.rows; ++v) {
    const auto* high = upper.counts.ptr<std::uint16_t>(v);
    const auto* low = lower.counts.ptr<std::uint16_t>(v);
    auto* out = metres.ptr<float>(v);
    for (int u = 0; u < metres.cols; ++u) {
      // By the bits: a signalling NaN would not survive being a number in passing.
      const std::uint32_t bits = static_cast<std::uint32_t>(swap_nan(high[u])) << 16 | low[u];
      std::memcpy(out + u, &bits, sizeof(bits));
    }
  }
  return metres;
}

void append(const Bytes& payload, Bytes& out) {
  out.insert(out.end(), payload.begin(), payload.end());
}

}  // namespace

Result<DepthFrame> quantise(const cv::Mat& metres, double step) {
  DepthFrame frame = {cv::Mat(metres.size(), CV_16UC1), step};
  for (int v = 0; v < metres.rows; ++v) {
    const auto* in = metres.ptr<float>(v);
    auto* out = frame.counts.ptr<std::uint16_t>(v);
    for (int u = 0; u < metres.cols; ++u) {
      out[u] = 0;
      if (!std::isfinite(in[u]) || in[u] <= 0.0f) continue;
      const double count = std::nearbyint(in[u] / step);
      if (!(count >= 1.0 && count <= 65535.0)) {
        return Error{"a reading is below half a step or beyond 65535 steps"};
      }
      out[u] = static_cast<std::uint16_t>(count);
    }
  }
  return frame;
}

Bytes pack_float(const cv::Mat& metres, DhcmMode mode, const EncodePlane& encode) {
  Header header;
  header.mode = mode;
  header.pixels = DhcmPixels::kFloat;
  header.width = metres.cols;
  header.height = metres.rows;
  Bytes out;
  for (const double unit : {0.001, 0.0002, 0.0001, 0.00025}) {
    for (const Layout layout : {kDoubleProduct, kFloatProduct}) {
      const std::optional<DepthFrame> frame = on_grid(metres, unit, layout);
      if (!frame) continue;
      header.unit = unit;
      begin(header, out);
      out.push_back(layout);
      append(encode(*frame), out);
      finish(out);
      return out;
    }
  }
  DepthFrame upper;
  DepthFrame lower;
  split_halves(metres, upper, lower);
  const Bytes first = encode(upper);
  begin(header, out);
  out.push_back(kHalves);
  for (std::size_t i = 0; i < 4; ++i) {
    out.push_back(static_cast<std::uint8_t>(first.size() >> (8 * i)));
  }
  append(first, out);
  append(encode(lower), out);
  finish(out);
  return out;
}

Result<cv::Mat> unpack_float(const Opened& opened, const DecodePlane& decode) {
  ByteReader reader(opened.body);
  const auto layout = reader.get<std::uint8_t>();
  const bool plain = opened.header.body == Body::kEvents && !opened.header.masked;
  if (!reader.ok() || !plain || layout > kHalves) return Error{"depth payload is malformed"};
  if (layout != kHalves) {
    const Result<DepthFrame> frame = decode(reader.get_view(reader.left()));
    if (!frame) return Error{frame.reason()};
    cv::Mat metres(frame->counts.size(), CV_32FC1);
    for (int v = 0; v < metres.rows; ++v) {
      for (int u = 0; u < metres.cols; ++u) {
        metres.at<float>(v, u) = grid_number(frame->counts.at<std::uint16_t>(v, u), frame->unit,
                                             static_cast<Layout>(layout));
      }
    }
    return metres;
  }
  const auto length = reader.get<std::uint32_t>();
  const ByteView first = reader.get_view(length);
  if (!reader.ok()) return Error{"depth payload is malformed"};
  const Result<DepthFrame> upper = decode(first);
  if (!upper) return Error{upper.reason()};
  const Result<DepthFrame> lower = decode(reader.get_view(reader.left()));
  if (!lower) return Error{lower.reason()};
  return join_halves(*upper, *lower);
}

}  // namespace rprr::dhcm
