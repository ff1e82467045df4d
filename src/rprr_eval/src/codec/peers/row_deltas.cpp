// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/row_deltas.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

void split_row_deltas(const cv::Mat& counts, Bytes& planes) {
  const std::size_t pixels = counts.total();
  planes.resize(2 * pixels);
  std::uint8_t* low = planes.data();
  std::uint8_t* high = planes.data() + pixels;
  for (int v = 0; v < counts.rows; ++v) {
    const auto* row = counts.ptr<std::uint16_t>(v);
    std::uint16_t left = 0;
    for (int u = 0; u < counts.cols; ++u) {
      const auto delta = static_cast<std::int16_t>(row[u] - left);
      const auto folded = static_cast<std::uint16_t>(delta * 2 ^ delta >> 15);
      *low++ = static_cast<std::uint8_t>(folded);
      *high++ = static_cast<std::uint8_t>(folded >> 8);
      left = row[u];
    }
  }
}

void join_row_deltas(const Bytes& planes, cv::Mat& counts) {
  const std::uint8_t* low = planes.data();
  const std::uint8_t* high = planes.data() + counts.total();
  for (int v = 0; v < counts.rows; ++v) {
    auto* row = counts.ptr<std::uint16_t>(v);
    std::uint16_t left = 0;
    for (int u = 0; u < counts.cols; ++u) {
      const unsigned folded = *low++ | static_cast<unsigned>(*high++) << 8;
      const unsigned delta = folded >> 1 ^ (folded & 1 ? 0xffffu : 0u);
      left = static_cast<std::uint16_t>(left + delta);
      row[u] = left;
    }
  }
}

}  // namespace rprr
