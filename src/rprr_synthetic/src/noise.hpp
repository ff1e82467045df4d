// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rprr {

inline std::uint32_t hash_cell(int x, int y, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9e3779b9u + static_cast<std::uint32_t>(x) * 0x85ebca6bu +
                    static_cast<std::uint32_t>(y) * 0xc2b2ae35u;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return h ^ (h >> 16);
}

/// In [0, 1), constant over a cell.
inline float cell_value(int x, int y, std::uint32_t seed) {
  return static_cast<float>(hash_cell(x, y, seed) >> 8) * (1.0f / 16777216.0f);
}

inline int floor_int(float x) {
  const int i = static_cast<int>(x);
  return i - (x < static_cast<float>(i) ? 1 : 0);
}

/// Smooth noise in [-1, 1] with features one unit wide.
inline float value_noise(float x, float y, std::uint32_t seed) {
  const int ix = floor_int(x);
  const int iy = floor_int(y);
  float fx = x - static_cast<float>(ix);
  float fy = y - static_cast<float>(iy);
  fx = fx * fx * (3.0f - 2.0f * fx);
  fy = fy * fy * (3.0f - 2.0f * fy);
  const float top = cell_value(ix, iy, seed) * (1.0f - fx) + cell_value(ix + 1, iy, seed) * fx;
  const float low =
      cell_value(ix, iy + 1, seed) * (1.0f - fx) + cell_value(ix + 1, iy + 1, seed) * fx;
  return 2.0f * (top * (1.0f - fy) + low * fy) - 1.0f;
}

/// What is left of a structure of the given size (metres) in a pixel that covers `footprint`.
inline float visibility(float size, float footprint) {
  return std::clamp(2.0f - 2.0f * footprint / size, 0.0f, 1.0f);
}

/// value_noise of features `size` wide, faded by the footprint.
inline float faded_noise(float u, float v, float size_u, float size_v, float footprint,
                         std::uint32_t seed) {
  const float seen = visibility(std::min(size_u, size_v), footprint);
  return seen > 0.0f ? seen * value_noise(u / size_u, v / size_v, seed) : 0.0f;
}

/// Octaves of noise from `size` downwards, each half as wide and half as strong; about [-1, 1].
inline float fractal_noise(float u, float v, float size, float stretch, float footprint,
                           std::uint32_t seed, int octaves) {
  float sum = 0.0f;
  float strength = 0.5f;
  for (int i = 0; i < octaves; ++i) {
    const float seen = visibility(size, footprint);
    if (seen <= 0.0f) break;
    sum += seen * strength *
           value_noise(u / (size * stretch), v / size, seed + static_cast<std::uint32_t>(i));
    size *= 0.5f;
    strength *= 0.55f;
  }
  return 1.3f * sum;
}

/// 1 on lines of a width at the borders between cells of a period, else 0, smoothed by the
/// footprint. `x` is measured in metres.
inline float grid_line(float x, float period, float width, float footprint) {
  const float cell = x / period - std::floor(x / period);
  const float distance = period * std::min(cell, 1.0f - cell);
  const float soft = std::max(footprint, 1e-4f);
  const float inside = std::clamp((0.5f * width - distance) / soft + 0.5f, 0.0f, 1.0f);
  const float share = width / period;
  const float seen = visibility(0.5f * period, footprint);
  return share + seen * (inside * std::min(1.0f, (width + soft) / (2.0f * soft)) - share);
}

}  // namespace rprr
