// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_station/view_synthesis.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>

#include "rprr_geometry/pixel_map.hpp"

namespace rprr {
namespace {

// Fetches colours of the reference image for points of the target view.
class Fetcher {
 public:
  Fetcher(const DepthFrame& depth, const cv::Mat& bgr, float tolerance)
      : depth_(depth),
        bgr_(bgr),
        unit_(static_cast<float>(depth.unit)),
        tolerance_(tolerance),
        right_(static_cast<float>(depth.width() - 1)),
        bottom_(static_cast<float>(depth.height() - 1)) {}

  // Colour at (x, y), if the reference shows the surface at depth z there, or has no depth there.
  bool fetch(float x, float y, float z, std::uint8_t* colour) const {
    if (!(x >= -0.5f && y >= -0.5f && x < right_ + 0.5f && y < bottom_ + 0.5f)) return false;
    x = std::clamp(x, 0.0f, right_);
    y = std::clamp(y, 0.0f, bottom_);
    const int nearest_u = static_cast<int>(x + 0.5f);
    const int nearest_v = static_cast<int>(y + 0.5f);
    const float seen = unit_ * depth_.counts.ptr<std::uint16_t>(nearest_v)[nearest_u];
    if (seen > 0.0f && std::abs(seen - z) > tolerance_ * z) return false;
    interpolate(x, y, colour);
    return true;
  }

 private:
  void interpolate(float x, float y, std::uint8_t* colour) const {
    const int u = static_cast<int>(x);
    const int v = static_cast<int>(y);
    const int u_step = u + 1 < bgr_.cols ? 3 : 0;
    const auto* upper = bgr_.ptr<std::uint8_t>(v) + 3 * u;
    const auto* lower = bgr_.ptr<std::uint8_t>(std::min(v + 1, bgr_.rows - 1)) + 3 * u;
    // 7 bits each way: what 8-bit colours deserve.
    const int right = static_cast<int>((x - static_cast<float>(u)) * 128.0f + 0.5f);
    const int down = static_cast<int>((y - static_cast<float>(v)) * 128.0f + 0.5f);
    for (int i = 0; i < 3; ++i) {
      const int above = upper[i] * (128 - right) + upper[i + u_step] * right;
      const int below = lower[i] * (128 - right) + lower[i + u_step] * right;
      colour[i] = static_cast<std::uint8_t>((above * (128 - down) + below * down + 8192) >> 14);
    }
  }

  const DepthFrame& depth_;
  const cv::Mat& bgr_;
  float unit_;
  float tolerance_;
  float right_;
  float bottom_;
};

void prepare(const Camera& camera, PredictedView& view) {
  const cv::Size size(camera.width, camera.height);
  view.bgr.create(size, CV_8UC3);
  view.metres.create(size, CV_32FC1);
  view.provenance.create(size, CV_8UC1);
  view.bgr.setTo(0);
}

}  // namespace

ViewSynthesizer::ViewSynthesizer(SynthesisOptions options)
    : options_(options), crack_filter_(options.crack_filter) {
}

void ViewSynthesizer::synthesize(const DepthFrame& a, const cv::Mat& a_bgr, const Camera& a_camera,
                                 const Camera& b_camera, const Pose& m_ab, PredictedView& view) {
  prepare(b_camera, view);
  const cv::Size a_size(a_camera.width, a_camera.height);
  if (a.counts.size() != a_size || a_bgr.size() != a_size || a_bgr.type() != CV_8UC3 ||
      !a_bgr.isContinuous()) {
    view.metres.setTo(0);
    view.provenance.setTo(kNothing);
    return;
  }
  warp_depth(a, a_camera, b_camera, m_ab, warped_);
  crack_filter_.mend(warped_.metres, view.provenance);
  cv::swap(warped_.metres, view.metres);

  const PixelMap to_a(b_camera, a_camera, m_ab.inverse(), 1.0);
  const Fetcher fetcher(a, a_bgr, options_.surface_tolerance);
  const auto* const a_pixels = a_bgr.ptr<std::uint8_t>();
  for (int v = 0; v < b_camera.height; ++v) {
    const Eigen::Vector3f row_start = to_a.row(v);
    auto* const depth = view.metres.ptr<float>(v);
    auto* const provenance = view.provenance.ptr<std::uint8_t>(v);
    auto* const colours = view.bgr.ptr<std::uint8_t>(v);
    const auto* const source = warped_.source.ptr<int>(v);
    for (int u = 0; u < b_camera.width; ++u) {
      if (!(depth[u] > 0.0f)) {
        provenance[u] = kNothing;
        continue;
      }
      const bool mended = provenance[u] != 0;
      provenance[u] = mended ? kMended : kPredicted;
      if (mended || options_.mode == Synthesis::kBackward) {
        const Eigen::Vector3f at =
            depth[u] * (row_start + static_cast<float>(u) * to_a.step) + to_a.offset;
        const float inverse = 1.0f / at.z();
        if (at.z() >= kNearestDepth &&
            fetcher.fetch(at.x() * inverse, at.y() * inverse, at.z(), colours + 3 * u)) {
          continue;
        }
      }
      if (!mended) {
        std::memcpy(colours + 3 * u, a_pixels + 3 * source[u], 3);
      } else {
        depth[u] = 0.0f;  // the reference shows another surface there: nothing known
        provenance[u] = kNothing;
      }
    }
  }
}

}  // namespace rprr
