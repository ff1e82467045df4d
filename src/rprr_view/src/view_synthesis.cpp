// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/view_synthesis.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <opencv2/core.hpp>

#include "fetcher.hpp"

namespace rprr {
namespace {

constexpr int kAlignment = 4;  // images are aligned at a quarter of their size

void prepare(const Camera& camera, PredictedView& view) {
  const cv::Size size(camera.width, camera.height);
  view.bgr.create(size, CV_8UC3);
  view.metres.create(size, CV_32FC1);
  view.provenance.create(size, CV_8UC1);
  view.bgr.setTo(0);
}

// Mean brightness (of all channels) of cells of side x side pixels, as far as the image goes; side
// at most 8.
void reduce_brightness(const cv::Mat& bgr, int side, cv::Mat& out,
                       std::vector<std::uint16_t>& sums) {
  out.create((bgr.rows + side - 1) / side, (bgr.cols + side - 1) / side, CV_32FC1);
  sums.resize(static_cast<std::size_t>(3 * bgr.cols));
  for (int v = 0; v < out.rows; ++v) {
    const int height = std::min(side, bgr.rows - v * side);
    std::fill(sums.begin(), sums.end(), std::uint16_t{0});
    for (int y = 0; y < height; ++y) {
      const auto* from = bgr.ptr<std::uint8_t>(v * side + y);
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] = static_cast<std::uint16_t>(sums[i] + from[i]);
      }
    }
    auto* to = out.ptr<float>(v);
    for (int u = 0; u < out.cols; ++u) {
      const int count = 3 * std::min(side, bgr.cols - u * side);
      const auto first = sums.begin() + 3 * side * u;
      to[u] = static_cast<float>(std::accumulate(first, first + count, 0)) /
              static_cast<float>(height * count);
    }
  }
}

float sample(const cv::Mat& image, float x, float y) {
  x = std::clamp(x, 0.0f, static_cast<float>(image.cols - 1));
  y = std::clamp(y, 0.0f, static_cast<float>(image.rows - 1));
  const int u = static_cast<int>(x);
  const int v = static_cast<int>(y);
  const int next = std::min(u + 1, image.cols - 1);
  const auto* upper = image.ptr<float>(v);
  const auto* lower = image.ptr<float>(std::min(v + 1, image.rows - 1));
  const float across = x - static_cast<float>(u);
  const float above = upper[u] + across * (upper[next] - upper[u]);
  const float below = lower[u] + across * (lower[next] - lower[u]);
  return above + (y - static_cast<float>(v)) * (below - above);
}

// Pixels and depth in the reference's view.
struct Projected {
  float* x;
  float* y;
  float* z;
};

// Places (column, row) of the target at depths z. Plain pointers, so that compilers vectorise it.
void project(const PixelMap& map, const float* __restrict z, const float* __restrict column,
             const float* __restrict row, int count, const Projected& out) {
  const Eigen::Matrix3f m = map.map.cast<float>();
  const float m00 = m(0, 0), m01 = m(0, 1), m02 = m(0, 2), t0 = map.offset.x();
  const float m10 = m(1, 0), m11 = m(1, 1), m12 = m(1, 2), t1 = map.offset.y();
  const float m20 = m(2, 0), m21 = m(2, 1), m22 = m(2, 2), t2 = map.offset.z();
  float* __restrict const x = out.x;
  float* __restrict const y = out.y;
  float* __restrict const z_out = out.z;
  for (int u = 0; u < count; ++u) {
    const float depth = z[u] * (m20 * column[u] + m21 * row[u] + m22) + t2;
    const float inverse = 1.0f / depth;
    x[u] = (z[u] * (m00 * column[u] + m01 * row[u] + m02) + t0) * inverse;
    y[u] = (z[u] * (m10 * column[u] + m11 * row[u] + m12) + t1) * inverse;
    z_out[u] = depth;
  }
}

}  // namespace

ViewSynthesizer::ViewSynthesizer(SynthesisOptions options)
    : options_(options), crack_filter_(options.crack_filter) {
}

void ViewSynthesizer::synthesize(const DepthFrame& a, const cv::Mat& a_bgr, const Camera& a_camera,
                                 const Camera& b_camera, const Pose& b_from_a, PredictedView& view,
                                 const BaseImage* base) {
  prepare(b_camera, view);
  const cv::Size a_size(a_camera.width, a_camera.height);
  if (a.counts.size() != a_size || a_bgr.size() != a_size || a_bgr.type() != CV_8UC3 ||
      !a_bgr.isContinuous() || !a.counts.isContinuous()) {
    view.metres.setTo(0);
    view.provenance.setTo(kNothing);
    return;
  }
  const bool backward = options_.mode == Synthesis::kBackward;
  warp_depth(a, a_camera, b_camera, b_from_a, warped_,
             backward ? Footprint::kSurface : Footprint::kNearest);
  crack_filter_.mend(warped_.metres, view.provenance);
  cv::swap(warped_.metres, view.metres);

  const PixelMap to_a(b_camera, a_camera, b_from_a.inverse(), 1.0);
  shifts_.release();
  if (backward && options_.align && base != nullptr && base->reduction <= kAlignment) {
    align(a_bgr, to_a, *base, view.metres);
  }
  const Fetcher fetcher(a, a_bgr, options_.surface_tolerance);
  rows_.create(6, b_camera.width, CV_32FC1);
  places_.create(5, b_camera.width, CV_32SC1);
  shows_.create(1, b_camera.width, CV_8UC1);
  for (int v = 0; v < b_camera.height; ++v) fetch_row(fetcher, to_a, v, view);
}

// Shifts between the prediction, at a quarter of its size, and the base.
void ViewSynthesizer::align(const cv::Mat& a_bgr, const PixelMap& to_a, const BaseImage& base,
                            const cv::Mat& metres) {
  reduce_brightness(a_bgr, kAlignment, a_brightness_, sums_);
  reduce_brightness(base.bgr, kAlignment / base.reduction, wanted_, sums_);
  brightness_.create(wanted_.size(), CV_32FC1);
  valid_.create(wanted_.size(), CV_8UC1);
  constexpr float kCentre = 0.5f * (kAlignment - 1);
  for (int v = 0; v < wanted_.rows; ++v) {
    const int row = std::min(kAlignment * v + kAlignment / 2, metres.rows - 1);
    const Eigen::Vector3f row_start = to_a.row(row);
    for (int u = 0; u < wanted_.cols; ++u) {
      const int column = std::min(kAlignment * u + kAlignment / 2, metres.cols - 1);
      const float z = metres.ptr<float>(row)[column];
      const Eigen::Vector3f at =
          z * (row_start + static_cast<float>(column) * to_a.step) + to_a.offset;
      const bool known = z > 0.0f && at.z() >= kNearestDepth;
      valid_.ptr<std::uint8_t>(v)[u] = known ? 1 : 0;
      // From the pixel looked at to its cell's centre is the same way in both images, nearly.
      const float off = kCentre - kAlignment / 2;
      brightness_.ptr<float>(v)[u] =
          known ? sample(a_brightness_, (at.x() / at.z() + off - kCentre) / kAlignment,
                         (at.y() / at.z() + off - kCentre) / kAlignment)
                : 0.0f;
    }
  }
  shifts_ = alignment_.align(brightness_, valid_, wanted_);
}

// Where to look in the prediction's depth for pixels of a row that are fetched from where they are
// shifted to (columns and rows there), and the depths found; own ones where there is none.
const float* ViewSynthesizer::shift_row(int v, const cv::Mat& metres, float* __restrict column,
                                        float* __restrict row) {
  const int width = metres.cols;
  shifts_of_row(shifts_, kAlignment, v, width, column, row);
  const auto here = static_cast<float>(v);
  const auto right = static_cast<float>(width - 1);
  const auto bottom = static_cast<float>(metres.rows - 1);
  const auto stride = static_cast<int>(metres.step1());
  int* __restrict const place = places_.ptr<int>(0);
  for (int u = 0; u < width; ++u) {
    column[u] += static_cast<float>(u);
    row[u] += here;
    const float x = std::min(std::max(column[u] + 0.5f, 0.0f), right);
    const float y = std::min(std::max(row[u] + 0.5f, 0.0f), bottom);
    place[u] = static_cast<int>(y) * stride + static_cast<int>(x);
  }
  const auto* const all = metres.ptr<float>();
  const auto* const own = metres.ptr<float>(v);
  float* const z = rows_.ptr<float>(5);
  for (int u = 0; u < width; ++u) {
    const float there = all[place[u]];
    z[u] = there > 0.0f ? there : own[u];
  }
  return z;
}

void ViewSynthesizer::fetch_row(const Fetcher& shared, const PixelMap& to_a, int v,
                                PredictedView& view) {
  const int width = view.metres.cols;
  float* const depth = view.metres.ptr<float>(v);
  const float* z = depth;
  float* const column = rows_.ptr<float>(0);
  float* const row = rows_.ptr<float>(1);
  if (!shifts_.empty()) {
    z = shift_row(v, view.metres, column, row);
  } else {
    for (int u = 0; u < width; ++u) column[u] = static_cast<float>(u);
    std::fill(row, row + width, static_cast<float>(v));
  }
  const Projected at{rows_.ptr<float>(2), rows_.ptr<float>(3), rows_.ptr<float>(4)};
  project(to_a, z, column, row, width, at);

  const Fetcher fetcher = shared;  // its own, so that compilers see that colours do not alias it
  const FetchPlaces places{places_.ptr<int>(0), places_.ptr<int>(1), places_.ptr<int>(2),
                           places_.ptr<int>(3), places_.ptr<int>(4)};
  auto* const shows = shows_.ptr<std::uint8_t>();
  float* const seen = column;  // not needed any more
  fetcher.find_places(at.x, at.y, width, places);
  fetcher.look(places.nearest, width, seen);
  fetcher.compare(places.nearest, seen, at.z, width, shows);

  auto* const provenance = view.provenance.ptr<std::uint8_t>(v);
  auto* const colours = view.bgr.ptr<std::uint8_t>(v);
  const auto* const source = warped_.source.ptr<int>(v);
  const bool backward = options_.mode == Synthesis::kBackward;
  for (int u = 0; u < width; ++u) {
    if (!(depth[u] > 0.0f)) {
      provenance[u] = kNothing;
      continue;
    }
    const bool mended = provenance[u] != 0;
    provenance[u] = mended ? kMended : kPredicted;
    if ((mended || backward) && shows[u] != 0) {
      fetcher.fetch(places, u, colours + 3 * u);
    } else if (!mended) {
      std::memcpy(colours + 3 * u, fetcher.pixel(source[u]), 3);
    } else {
      // The reference shows another surface there: nothing known. Rows to come may be shifted to
      // here, and take their own depth then.
      depth[u] = 0.0f;
      provenance[u] = kNothing;
    }
  }
}

}  // namespace rprr
