// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rprr {
namespace {

constexpr float kEdge = 0.08f;        // relative depth step between cells that is another surface
constexpr int kFewestNeighbours = 5;  // of nine

void resize(PreviewView& view) {
  const auto n = static_cast<std::size_t>(view.camera.width * view.camera.height);
  for (auto* array : {&view.z, &view.x, &view.y, &view.nx, &view.ny, &view.nz, &view.luma,
                      &view.blue, &view.red, &view.sigma}) {
    array->assign(n, 0.0f);
  }
}

// A camera whose pixels are cells of side pixels of the given one.
Camera cell_camera(const Camera& camera, int side, int columns, int rows) {
  const double offset = 0.5 * (side - 1);
  return {columns,
          rows,
          camera.fx / side,
          camera.fy / side,
          (camera.cx - offset) / side,
          (camera.cy - offset) / side};
}

// resolution: of z, metres, as a function of z; what the view was rounded to.
template <typename Resolution>
void place_points(PreviewView& view, const Resolution& resolution) {
  for (int r = 0; r < view.height(); ++r) {
    for (int c = 0; c < view.width(); ++c) {
      const auto i = static_cast<std::size_t>(r * view.width() + c);
      const float z = view.z[i];
      if (z == 0.0f) continue;
      view.x[i] = static_cast<float>((c - view.camera.cx) / view.camera.fx) * z;
      view.y[i] = static_cast<float>((r - view.camera.cy) / view.camera.fy) * z;
      const auto noise = static_cast<float>(depth_sigma(z));
      const auto rounding = static_cast<float>(0.29 * resolution(static_cast<double>(z)));
      view.sigma[i] = std::sqrt(noise * noise + rounding * rounding);
    }
  }
}

// Plane through 1/z of the 3x3 neighbourhood, as far as it is one surface.
void fit_normal(PreviewView& view, int c, int r) {
  const auto i = static_cast<std::size_t>(r * view.width() + c);
  const float centre = view.z[i];
  if (centre == 0.0f) return;
  float sxx = 0, syy = 0, sxy = 0, sx = 0, sy = 0, sq = 0, sxq = 0, syq = 0;
  int n = 0;
  for (int dr = -1; dr <= 1; ++dr) {
    for (int dc = -1; dc <= 1; ++dc) {
      const int column = c + dc;
      const int row = r + dr;
      if (column < 0 || row < 0 || column >= view.width() || row >= view.height()) continue;
      const float z = view.z[static_cast<std::size_t>(row * view.width() + column)];
      if (z == 0.0f || std::abs(z - centre) > kEdge * centre) continue;
      const float q = 1.0f / z;
      const auto u = static_cast<float>(dc);
      const auto v = static_cast<float>(dr);
      sxx += u * u, syy += v * v, sxy += u * v, sx += u, sy += v;
      sq += q, sxq += u * q, syq += v * q;
      ++n;
    }
  }
  if (n < kFewestNeighbours) return;
  const auto count = static_cast<float>(n);
  const float cxx = sxx - sx * sx / count, cyy = syy - sy * sy / count, cxy = sxy - sx * sy / count;
  const float cxq = sxq - sx * sq / count, cyq = syq - sy * sq / count;
  const float determinant = cxx * cyy - cxy * cxy;
  if (determinant < 0.5f) return;
  const float slope_u = (cxq * cyy - cyq * cxy) / determinant;
  const float slope_v = (cyq * cxx - cxq * cxy) / determinant;
  // n . p = d gives q = (n / d) . (x/z, y/z, 1).
  const float a = slope_u * static_cast<float>(view.camera.fx);
  const float b = slope_v * static_cast<float>(view.camera.fy);
  const float q0 = (sq - slope_u * sx - slope_v * sy) / count;
  const float g = q0 - a * view.x[i] / centre - b * view.y[i] / centre;
  const float length = std::sqrt(a * a + b * b + g * g);
  if (!(length > 0.0f)) return;
  view.nx[i] = -a / length;
  view.ny[i] = -b / length;
  view.nz[i] = -g / length;
}

void fit_normals(PreviewView& view) {
  for (int r = 0; r < view.height(); ++r) {
    for (int c = 0; c < view.width(); ++c) fit_normal(view, c, r);
  }
}

}  // namespace

int PreviewView::valid_count() const {
  return static_cast<int>(std::count_if(z.begin(), z.end(), [](float d) { return d > 0.0f; }));
}

PreviewView make_view(const BlockPreview& preview, const Camera& camera) {
  PreviewView view;
  view.camera = cell_camera(camera, kBlockSide, preview.grid.columns, preview.grid.rows);
  resize(view);
  for (std::size_t i = 0; i < view.size(); ++i) {
    view.z[i] = static_cast<float>(preview.metres(static_cast<int>(i)));
    const std::uint8_t* bgr = preview.bgr.ptr<std::uint8_t>() + 3 * i;
    view.luma[i] = 0.114f * bgr[0] + 0.587f * bgr[1] + 0.299f * bgr[2];
    view.blue[i] = bgr[0] - view.luma[i];
    view.red[i] = bgr[2] - view.luma[i];
  }
  place_points(view, [&](double z) { return preview.resolution(z); });
  fit_normals(view);
  return view;
}

PreviewView half_view(const PreviewView& view) {
  PreviewView half;
  half.camera = cell_camera(view.camera, 2, (view.width() + 1) / 2, (view.height() + 1) / 2);
  resize(half);
  for (int r = 0; r < half.height(); ++r) {
    for (int c = 0; c < half.width(); ++c) {
      const auto out = static_cast<std::size_t>(r * half.width() + c);
      std::array<float, 4> z{};
      float luma = 0, blue = 0, red = 0;
      int cells = 0;
      int valid = 0;
      for (int k = 0; k < 4; ++k) {
        const int column = 2 * c + k % 2;
        const int row = 2 * r + k / 2;
        if (column >= view.width() || row >= view.height()) continue;
        const auto in = static_cast<std::size_t>(row * view.width() + column);
        luma += view.luma[in], blue += view.blue[in], red += view.red[in];
        ++cells;
        if (view.z[in] > 0.0f) z[static_cast<std::size_t>(valid++)] = view.z[in];
      }
      const auto n = static_cast<float>(cells);
      half.luma[out] = luma / n, half.blue[out] = blue / n, half.red[out] = red / n;
      if (valid < 2) continue;
      std::sort(z.begin(), z.begin() + valid);
      const float middle = z[static_cast<std::size_t>(valid / 2)];
      float q = 0;
      int same = 0;
      for (int k = 0; k < valid; ++k) {
        if (std::abs(z[static_cast<std::size_t>(k)] - middle) > kEdge * middle) continue;
        q += 1.0f / z[static_cast<std::size_t>(k)];
        ++same;
      }
      half.z[out] = static_cast<float>(same) / q;
    }
  }
  place_points(half, [](double) { return 0.0; });
  fit_normals(half);
  return half;
}

}  // namespace rprr
