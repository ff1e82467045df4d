// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/smooth_fill.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace rprr {
namespace {

// Brings a sum of weights down to at most 1, so that one known pixel counts as much as four.
cv::Vec4f normalised(const cv::Vec4f& sum) {
  return sum[3] > 1.0f ? sum * (1.0f / sum[3]) : sum;
}

void pull_from_image(const cv::Mat& bgr, const cv::Mat& known, cv::Mat& coarse) {
  coarse.create((bgr.rows + 1) / 2, (bgr.cols + 1) / 2, CV_32FC4);
  for (int v = 0; v < coarse.rows; ++v) {
    auto* out = coarse.ptr<cv::Vec4f>(v);
    for (int u = 0; u < coarse.cols; ++u) {
      int sum[4] = {0, 0, 0, 0};
      for (int y = 2 * v; y < std::min(2 * v + 2, bgr.rows); ++y) {
        const auto* colour = bgr.ptr<std::uint8_t>(y);
        const auto* flag = known.ptr<std::uint8_t>(y);
        for (int x = 2 * u; x < std::min(2 * u + 2, bgr.cols); ++x) {
          const int weight = flag[x] != 0 ? 1 : 0;
          for (int i = 0; i < 3; ++i) sum[i] += weight * colour[3 * x + i];
          sum[3] += weight;
        }
      }
      const float scale = sum[3] > 0 ? 1.0f / static_cast<float>(sum[3]) : 0.0f;
      out[u] = {static_cast<float>(sum[0]) * scale, static_cast<float>(sum[1]) * scale,
                static_cast<float>(sum[2]) * scale, sum[3] > 0 ? 1.0f : 0.0f};
    }
  }
}

void pull(const cv::Mat& fine, cv::Mat& coarse) {
  coarse.create((fine.rows + 1) / 2, (fine.cols + 1) / 2, CV_32FC4);
  for (int v = 0; v < coarse.rows; ++v) {
    auto* out = coarse.ptr<cv::Vec4f>(v);
    for (int u = 0; u < coarse.cols; ++u) {
      cv::Vec4f sum(0, 0, 0, 0);
      for (int y = 2 * v; y < std::min(2 * v + 2, fine.rows); ++y) {
        const auto* in = fine.ptr<cv::Vec4f>(y);
        for (int x = 2 * u; x < std::min(2 * u + 2, fine.cols); ++x) sum += in[x];
      }
      out[u] = normalised(sum);
    }
  }
}

// The coarse level between its pixels, at the place of pixel (u, v) of the finer one.
cv::Vec4f between(const cv::Mat& coarse, int u, int v) {
  const int u_near = u / 2;
  const int v_near = v / 2;
  const int u_next = std::clamp(u_near + (u % 2 == 0 ? -1 : 1), 0, coarse.cols - 1);
  const int v_next = std::clamp(v_near + (v % 2 == 0 ? -1 : 1), 0, coarse.rows - 1);
  const auto* near = coarse.ptr<cv::Vec4f>(v_near);
  const auto* next = coarse.ptr<cv::Vec4f>(v_next);
  return 0.5625f * near[u_near] + 0.1875f * (near[u_next] + next[u_near]) + 0.0625f * next[u_next];
}

void push(const cv::Mat& coarse, cv::Mat& fine) {
  for (int v = 0; v < fine.rows; ++v) {
    auto* out = fine.ptr<cv::Vec4f>(v);
    for (int u = 0; u < fine.cols; ++u) {
      if (out[u][3] < 1.0f) out[u] += (1.0f - out[u][3]) * between(coarse, u, v);
    }
  }
}

}  // namespace

void SmoothFiller::fill(cv::Mat& bgr, const cv::Mat& known) {
  const int unknown = static_cast<int>(known.total()) - cv::countNonZero(known);
  if (unknown == 0) return;
  if (unknown == static_cast<int>(known.total())) {
    bgr.setTo(cv::Scalar::all(128));
    return;
  }
  std::size_t count = 0;  // down to a single pixel, which is known
  for (int side = std::max(bgr.cols, bgr.rows); side > 1 || count == 0; side = (side + 1) / 2) {
    ++count;
  }
  levels_.resize(count);
  pull_from_image(bgr, known, levels_[0]);
  for (std::size_t i = 1; i < count; ++i) pull(levels_[i - 1], levels_[i]);
  for (std::size_t i = count - 1; i > 0; --i) push(levels_[i], levels_[i - 1]);
  for (int v = 0; v < bgr.rows; ++v) {
    auto* colour = bgr.ptr<std::uint8_t>(v);
    const auto* flag = known.ptr<std::uint8_t>(v);
    for (int u = 0; u < bgr.cols; ++u) {
      if (flag[u] != 0) continue;
      const cv::Vec4f value = between(levels_[0], u, v);
      for (int i = 0; i < 3; ++i) {
        colour[3 * u + i] = static_cast<std::uint8_t>(std::clamp(value[i] + 0.5f, 0.0f, 255.0f));
      }
    }
  }
}

}  // namespace rprr
