// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_agreement.hpp"

#include <algorithm>
#include <cmath>

#include "rprr_pose/pinhole.hpp"

namespace rprr {
namespace {

constexpr float kNearest = 0.1f;

// Tolerance of one surface's depth seen from two places: noise of both, and registration.
float tolerance(float sigma_one, float sigma_other, float z) {
  return 3.0f * std::sqrt(sigma_one * sigma_one + sigma_other * sigma_other) + 0.01f + 0.01f * z;
}

struct Moments {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  void add(double x, double y) { ++n, a += x, b += y, aa += x * x, bb += y * y, ab += x * y; }
  double variance_b() const { return n > 0 ? std::max(0.0, bb / n - b / n * b / n) : 0.0; }
  double correlation() const {
    if (n < 8) return 0.0;
    const double va = aa / n - a / n * a / n;
    const double vb = bb / n - b / n * b / n;
    const double cov = ab / n - a / n * b / n;
    return va > 1e-6 && vb > 1e-6 ? cov / std::sqrt(va * vb) : 0.0;
  }
  // Variance of the difference.
  double spread() const {
    if (n < 1) return 0.0;
    const double mean = (a - b) / n;
    return std::max(0.0, (aa - 2 * ab + bb) / n - mean * mean);
  }
};

// Depth range that the fixed view shows within one cell of a place.
struct Range {
  float least = 1e9f;
  float most = 0.0f;
};

Range range_around(const PreviewView& view, int c, int r) {
  Range range;
  for (int row = std::max(r - 1, 0); row <= std::min(r + 1, view.height() - 1); ++row) {
    for (int column = std::max(c - 1, 0); column <= std::min(c + 1, view.width() - 1); ++column) {
      const float z = view.z[static_cast<std::size_t>(row * view.width() + column)];
      if (z == 0.0f) continue;
      range.least = std::min(range.least, z);
      range.most = std::max(range.most, z);
    }
  }
  return range;
}

// Bilinear luma inside the view.
float luma_at(const PreviewView& view, float u, float v) {
  u = std::clamp(u, 0.0f, static_cast<float>(view.width()) - 1.001f);
  v = std::clamp(v, 0.0f, static_cast<float>(view.height()) - 1.001f);
  const auto c = static_cast<int>(u);
  const auto r = static_cast<int>(v);
  const float fu = u - static_cast<float>(c);
  const float fv = v - static_cast<float>(r);
  const float* p = view.luma.data() + r * view.width() + c;
  const float top = p[0] + fu * (p[1] - p[0]);
  const float bottom = p[view.width()] + fu * (p[view.width() + 1] - p[view.width()]);
  return top + fv * (bottom - top);
}

}  // namespace

Agreement agreement(const PreviewView& moving, const PreviewView& fixed,
                    const Pose& fixed_from_moving) {
  Agreement out;
  const Eigen::Matrix3f rotation = fixed_from_moving.linear().cast<float>();
  const Eigen::Vector3f translation = fixed_from_moving.translation().cast<float>();
  const Pinhole fixed_camera(fixed.camera);
  Moments luma, blue, red, fine;
  // The fixed luma where the cells of the moving view land; NaN where they do not.
  std::vector<float> landed(moving.size(), std::nanf(""));
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (moving.z[i] == 0.0f) continue;
    ++out.valid;
    const Eigen::Vector3f p =
        rotation * Eigen::Vector3f(moving.x[i], moving.y[i], moving.z[i]) + translation;
    if (p.z() < kNearest) continue;
    const float u = fixed_camera.fx * p.x() / p.z() + fixed_camera.cx;
    const float v = fixed_camera.fy * p.y() / p.z() + fixed_camera.cy;
    const int index = fixed_camera.index(u, v);
    if (index < 0) continue;
    const auto j = static_cast<std::size_t>(index);
    if (fixed.z[j] == 0.0f) continue;
    ++out.in_view;
    const float limit = tolerance(moving.sigma[i], fixed.sigma[j], p.z());
    const Range range = range_around(fixed, index % fixed.width(), index / fixed.width());
    if (p.z() < range.least - 2.0f * limit) {
      ++out.violating;
    } else if (p.z() > range.most + 2.0f * limit) {
      ++out.hidden;
    } else if (p.z() > range.least - limit && p.z() < range.most + limit) {
      ++out.consistent;
      const float difference = p.z() - std::clamp(p.z(), std::min(fixed.z[j], range.most),
                                                  std::max(fixed.z[j], range.least));
      const float direct = p.z() - fixed.z[j];
      const float off = std::abs(difference) < std::abs(direct) ? direct : difference;
      const float variance = moving.sigma[i] * moving.sigma[i] + fixed.sigma[j] * fixed.sigma[j] +
                             1e-4f + 1e-4f * p.z() * p.z();
      out.chi2 += std::min(9.0f, off * off / variance);
      landed[i] = luma_at(fixed, u, v);
      luma.add(moving.luma[i], landed[i]);
      blue.add(moving.blue[i], fixed.blue[j]);
      red.add(moving.red[i], fixed.red[j]);
    }
  }
  // What differs from the cells around: structure, which exposure and shading leave alone.
  const int width = moving.width();
  for (int r = 1; r + 1 < moving.height(); ++r) {
    for (int c = 1; c + 1 < width; ++c) {
      const auto i = static_cast<std::size_t>(r * width + c);
      if (std::isnan(landed[i])) continue;
      float own = 0, other = 0;
      int n = 0;
      for (const int offset :
           {-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1}) {
        const auto k = static_cast<std::size_t>(static_cast<int>(i) + offset);
        if (std::isnan(landed[k])) continue;
        own += moving.luma[k], other += landed[k];
        ++n;
      }
      if (n < 4) continue;
      const auto count = static_cast<float>(n);
      fine.add(moving.luma[i] - own / count, landed[i] - other / count);
    }
  }
  out.correlation = luma.correlation();
  out.fine_correlation = fine.correlation();
  out.chroma_difference = std::sqrt(blue.spread() + red.spread());
  out.texture = std::sqrt(luma.variance_b());
  return out;
}

}  // namespace rprr
