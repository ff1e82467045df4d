// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/frame_views.hpp"

#include <utility>

namespace rprr {
namespace {

constexpr int kCoarsest = 16;  // cells in a row of the coarsest view: 80, 40 and 20 for VGA

// Means of 8x8 pixels, one every four: as smooth as a block's colour, sampled twice as finely.
cv::Mat smooth_luma(const cv::Mat& bgr, const Camera& camera, Camera& out_camera) {
  const int columns = bgr.cols / 4;
  const int rows = bgr.rows / 4;
  cv::Mat quarter(rows, columns, CV_32FC1);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      int sum = 0;
      for (int v = 4 * r; v < 4 * r + 4; ++v) {
        const auto* p = bgr.ptr<std::uint8_t>(v) + 12 * c;
        for (int k = 0; k < 12; k += 3) sum += 29 * p[k] + 150 * p[k + 1] + 77 * p[k + 2];
      }
      quarter.at<float>(r, c) = static_cast<float>(sum) / (16.0f * 256.0f);
    }
  }
  cv::Mat out(rows - 1, columns - 1, CV_32FC1);
  for (int r = 0; r + 1 < rows; ++r) {
    const auto* p = quarter.ptr<float>(r);
    const auto* q = quarter.ptr<float>(r + 1);
    auto* o = out.ptr<float>(r);
    for (int c = 0; c + 1 < columns; ++c) o[c] = 0.25f * (p[c] + p[c + 1] + q[c] + q[c + 1]);
  }
  // The first mean covers pixels 0 to 7, so its centre is 3.5; the next is four pixels on.
  out_camera = {out.cols,
                out.rows,
                camera.fx / 4,
                camera.fy / 4,
                (camera.cx - 3.5) / 4,
                (camera.cy - 3.5) / 4};
  return out;
}

cv::Mat metres_of(const DepthFrame& depth) {
  cv::Mat out(depth.counts.size(), CV_32FC1);
  const auto unit = static_cast<float>(depth.unit);
  for (int v = 0; v < out.rows; ++v) {
    const auto* in = depth.counts.ptr<std::uint16_t>(v);
    auto* o = out.ptr<float>(v);
    for (int u = 0; u < out.cols; ++u) o[u] = static_cast<float>(in[u]) * unit;
  }
  return out;
}

}  // namespace

std::vector<PreviewView> pyramid(PreviewView view) {
  std::vector<PreviewView> levels{std::move(view)};
  while (levels.back().width() / 2 >= kCoarsest) levels.push_back(half_view(levels.back()));
  if (levels.size() == 1) levels.push_back(half_view(levels.back()));
  return levels;
}

FixedView fine_view(const RgbdFrame& frame) {
  FixedView view;
  view.metres = metres_of(frame.depth);
  view.metres_camera = frame.camera;
  // Without colour the cells' even grey serves: depth alone then has to do, and is not enough to be
  // accepted.
  if (frame.bgr.type() == CV_8UC3 && frame.bgr.size() == frame.depth.counts.size()) {
    view.luma = smooth_luma(frame.bgr, frame.camera, view.luma_camera);
  }
  return view;
}

}  // namespace rprr
