// SPDX-License-Identifier: BSD-3-Clause
#include "texture.hpp"

#include "noise.hpp"

namespace rprr {
namespace {

using Colour = Eigen::Vector3f;

Colour mix(const Colour& a, const Colour& b, float share) {
  return a + std::clamp(share, 0.0f, 1.0f) * (b - a);
}

/// A lively colour by number, linear BGR.
Colour palette(std::uint32_t number) {
  static const float table[12][3] = {
      {0.35f, 0.08f, 0.05f}, {0.04f, 0.05f, 0.45f}, {0.06f, 0.25f, 0.06f}, {0.05f, 0.45f, 0.70f},
      {0.55f, 0.60f, 0.62f}, {0.03f, 0.03f, 0.04f}, {0.45f, 0.30f, 0.08f}, {0.10f, 0.12f, 0.30f},
      {0.20f, 0.45f, 0.60f}, {0.12f, 0.05f, 0.20f}, {0.30f, 0.35f, 0.10f}, {0.03f, 0.20f, 0.55f}};
  const float* row = table[number % 12];
  return {row[0], row[1], row[2]};
}

/// 0 to 1: ink of lines of letters, `height` from line to line, measured from the upper left.
float letters(float x, float y, float height, float footprint, std::uint32_t seed) {
  if (x < 0.0f || y < 0.0f) return 0.0f;
  const int row = floor_int(y / height);
  const float in_row = y / height - static_cast<float>(row);
  const float pitch = 0.6f * height;
  const int column = floor_int(x / pitch);
  if (in_row > 0.7f || hash_cell(column, row, seed) % 6 == 0) return 0.0f;
  constexpr float kMeanInk = 0.45f;
  const float seen = visibility(0.25f * height, footprint);
  if (seen <= 0.0f) return kMeanInk;
  const int stroke_x = floor_int((x / pitch - static_cast<float>(column)) * 4.0f);
  const int stroke_y = floor_int(in_row / 0.7f * 5.0f);
  const bool ink =
      stroke_x < 3 && (hash_cell(column, row, seed + 1) >> (stroke_y * 3 + stroke_x)) % 2 == 1;
  return kMeanInk + seen * ((ink ? 1.0f : 0.0f) - kMeanInk);
}

Colour plaster(const Material& m, const SurfacePoint& p) {
  const float stains = fractal_noise(p.u, p.v, 0.9f, 1.0f, p.footprint, m.seed, 3);
  const float grain = fractal_noise(p.u, p.v, 0.02f, 1.0f, p.footprint, m.seed + 7, 3);
  return m.colour * (1.0f + 0.10f * stains + 0.16f * grain);
}

Colour wood_grain(const Colour& light, const Colour& dark, float u, float v, float footprint,
                  std::uint32_t seed) {
  const float bend = 0.02f * value_noise(u * 2.0f, v * 6.0f, seed);
  const float veins = fractal_noise(u, v + bend, 0.035f, 14.0f, footprint, seed + 3, 4);
  const float pores = faded_noise(u, v, 0.03f, 0.0025f, footprint, seed + 9);
  return mix(light, dark, 0.45f + 0.75f * veins) * (1.0f + 0.15f * pores);
}

Colour wood(const Material& m, const SurfacePoint& p) {
  // The grain runs along the longer side.
  const bool upright = p.half_height > p.half_width;
  return wood_grain(m.colour, m.second, upright ? p.v : p.u, upright ? p.u : p.v, p.footprint,
                    m.seed + p.face);
}

Colour planks(const Material& m, const SurfacePoint& p) {
  constexpr float kWidth = 0.13f;
  constexpr float kLength = 1.1f;
  const int row = floor_int(p.v / kWidth);
  const float shifted = p.u + kLength * cell_value(row, 0, m.seed);
  const int plank = floor_int(shifted / kLength);
  const float tone = 0.75f + 0.5f * cell_value(plank, row, m.seed + 1);
  const float gap = std::max(grid_line(p.v, kWidth, 0.004f, p.footprint),
                             grid_line(shifted, kLength, 0.004f, p.footprint));
  const Colour grain = wood_grain(m.colour, m.second, p.u, p.v, p.footprint,
                                  m.seed + hash_cell(plank, row, 5) % 1000);
  return grain * tone * (1.0f - 0.7f * gap);
}

Colour bricks(const Material& m, const SurfacePoint& p) {
  constexpr float kHeight = 0.075f;
  constexpr float kLength = 0.22f;
  const int row = floor_int(p.v / kHeight);
  const float shifted = p.u + (row % 2 == 0 ? 0.0f : 0.5f * kLength);
  const int brick = floor_int(shifted / kLength);
  const float mortar = std::max(grid_line(p.v, kHeight, 0.012f, p.footprint),
                                grid_line(shifted, kLength, 0.012f, p.footprint));
  const float tone = 0.65f + 0.7f * cell_value(brick, row, m.seed);
  const float rough = fractal_noise(p.u, p.v, 0.03f, 1.0f, p.footprint, m.seed + 2, 4);
  return mix(m.colour * tone * (1.0f + 0.5f * rough), m.second * (1.0f + 0.3f * rough), mortar);
}

Colour tiles(const Material& m, const SurfacePoint& p) {
  constexpr float kSide = 0.15f;
  const int column = floor_int(p.u / kSide);
  const int row = floor_int(p.v / kSide);
  const float joint = std::max(grid_line(p.u, kSide, 0.006f, p.footprint),
                               grid_line(p.v, kSide, 0.006f, p.footprint));
  const bool painted = hash_cell(column, row, m.seed) % 4 == 0;
  const float marble = fractal_noise(p.u, p.v, 0.08f, 1.0f, p.footprint, m.seed + 4, 4);
  Colour tile = m.colour * (0.85f + 0.3f * cell_value(column, row, m.seed + 1) + 0.25f * marble);
  if (painted) {
    const float x = p.u / kSide - static_cast<float>(column) - 0.5f;
    const float y = p.v / kSide - static_cast<float>(row) - 0.5f;
    const float ring = std::sin(40.0f * (x * x + y * y)) * std::cos(9.0f * x) * std::cos(9.0f * y);
    tile = mix(tile, m.second, visibility(0.03f, p.footprint) * (ring > 0.1f ? 0.9f : 0.0f));
  }
  return tile * (1.0f - 0.65f * joint);
}

Colour fabric(const Material& m, const SurfacePoint& p) {
  const float stripe_u = grid_line(p.u, 0.16f, 0.05f, p.footprint);
  const float stripe_v = grid_line(p.v, 0.16f, 0.05f, p.footprint);
  const float thread = faded_noise(p.u, p.v, 0.004f, 0.012f, p.footprint, m.seed) +
                       faded_noise(p.u, p.v, 0.012f, 0.004f, p.footprint, m.seed + 1);
  const float folds = fractal_noise(p.u, p.v, 0.25f, 1.0f, p.footprint, m.seed + 2, 4);
  return mix(m.colour, m.second, 0.45f * (stripe_u + stripe_v)) *
         (1.0f + 0.25f * thread + 0.25f * folds);
}

Colour carpet(const Material& m, const SurfacePoint& p) {
  const float edge = std::min(p.half_width - std::abs(p.u), p.half_height - std::abs(p.v));
  const float pile = fractal_noise(p.u, p.v, 0.03f, 1.0f, p.footprint, m.seed, 4);
  const float cell_u = std::abs(p.u / 0.24f - std::floor(p.u / 0.24f) - 0.5f);
  const float cell_v = std::abs(p.v / 0.24f - std::floor(p.v / 0.24f) - 0.5f);
  const float diamond = cell_u + cell_v;
  Colour colour = m.colour;
  if (edge < 0.03f || (edge > 0.16f && edge < 0.19f)) {
    colour = palette(m.seed + 4);
  } else if (edge < 0.16f) {
    const bool zig = std::abs(p.u / 0.06f - std::round(p.u / 0.06f)) * 0.10f < edge - 0.06f;
    colour = zig ? m.second : palette(m.seed + 2);
  } else if (diamond < 0.14f) {
    colour = palette(m.seed + 3);
  } else if (diamond < 0.32f) {
    colour = m.second;
  }
  return colour * (1.0f + 0.45f * pile);
}

Colour speckle(const Material& m, const SurfacePoint& p) {
  const float coarse = fractal_noise(p.u, p.v, 0.03f, 1.0f, p.footprint, m.seed, 4);
  const float chips = fractal_noise(p.u, p.v, 0.012f, 1.0f, p.footprint, m.seed + 5, 2);
  return mix(m.colour, m.second, 0.3f + 1.2f * coarse + 0.8f * chips);
}

Colour landscape(const Material& m, float x, float y, const SurfacePoint& p) {
  const float ridge = 0.45f + 0.2f * value_noise(x * 3.0f, 0.0f, m.seed) +
                      0.08f * value_noise(x * 11.0f, 1.0f, m.seed) +
                      0.03f * value_noise(x * 37.0f, 2.0f, m.seed);
  const float strokes = fractal_noise(p.u, p.v, 0.05f, 2.0f, p.footprint, m.seed + 3, 4);
  if (y < ridge) {
    return mix(palette(m.seed + 2), m.second, y / ridge + 0.8f * strokes) * (1.0f + 0.4f * strokes);
  }
  const float sun = std::hypot(x - 0.7f, (y - 0.78f) * p.half_height / p.half_width);
  if (sun < 0.08f) return {0.25f, 0.65f, 0.90f};
  return mix(Colour(0.45f, 0.55f, 0.75f), m.colour, (y - ridge) * 1.5f + 0.6f * strokes);
}

Colour blocks(const Material& m, float x, float y, const SurfacePoint& p) {
  int depth = 0;
  std::uint32_t name = m.seed;
  float width = 2.0f * p.half_width;
  float height = 2.0f * p.half_height;
  for (; depth < 6; ++depth) {  // Cut the longer side in two until it is small enough.
    const float cut = 0.3f + 0.4f * cell_value(depth, static_cast<int>(name), m.seed);
    float& along = width > height ? x : y;
    float& size = width > height ? width : height;
    const bool low = along < cut;
    along = low ? along / cut : (along - cut) / (1.0f - cut);
    size *= low ? cut : 1.0f - cut;
    name = name * 2 + (low ? 0 : 1);
  }
  const float border = std::min({x * width, (1.0f - x) * width, y * height, (1.0f - y) * height});
  const float brush = fractal_noise(p.u, p.v, 0.03f, 2.0f, p.footprint, m.seed + 6, 3);
  if (border < 0.006f) return Colour::Constant(0.02f);
  return palette(hash_cell(static_cast<int>(name), 0, m.seed)) * (1.0f + 0.35f * brush);
}

Colour notice(const Material& m, float x, float y, const SurfacePoint& p) {
  const float from_left = x * 2.0f * p.half_width;
  const float from_top = (1.0f - y) * 2.0f * p.half_height;
  const Colour paper(0.70f, 0.76f, 0.78f);
  const Colour ink = palette(m.seed + 1) * 0.5f;
  if (from_top < 0.24f * p.half_height) {
    const float title =
        letters(from_left - 0.04f, from_top - 0.03f, 0.2f * p.half_height, p.footprint, m.seed);
    return mix(m.colour, paper, title);
  }
  if (y > 0.4f && y < 0.82f && x > 0.08f && x < 0.55f) {
    return landscape(m, (x - 0.08f) / 0.47f, (y - 0.4f) / 0.42f, p);
  }
  const float inset = y > 0.4f ? 0.6f * 2.0f * p.half_width : 0.04f;
  return mix(paper, ink, letters(from_left - inset, from_top, 0.03f, p.footprint, m.seed + 2));
}

Colour poster(const Material& m, const SurfacePoint& p) {
  const float edge = std::min(p.half_width - std::abs(p.u), p.half_height - std::abs(p.v));
  if (edge < 0.012f) return Colour::Constant(0.03f);
  if (edge < 0.03f && m.seed % 2 == 0) return Colour::Constant(0.7f);
  const float x = 0.5f + 0.5f * p.u / p.half_width;
  const float y = 0.5f + 0.5f * p.v / p.half_height;
  if (m.seed % 3 == 0) return landscape(m, x, y, p);
  return m.seed % 3 == 1 ? notice(m, x, y, p) : blocks(m, x, y, p);
}

Colour text(const Material& m, const SurfacePoint& p) {
  const float margin = 0.02f;
  const bool inside =
      std::abs(p.u) < p.half_width - margin && std::abs(p.v) < p.half_height - margin;
  const float ink = inside ? letters(p.u + p.half_width - margin, p.half_height - margin - p.v,
                                     0.016f, p.footprint, m.seed + p.face)
                           : 0.0f;
  return mix(m.colour, m.second, ink);
}

Colour books(const Material& m, const SurfacePoint& p) {
  constexpr float kPitch = 0.034f;
  const int slot = floor_int(p.u / kPitch);
  const float in_slot = p.u - kPitch * static_cast<float>(slot);
  // Neighbours share a border that strays from the even raster.
  const float left = 0.012f * cell_value(slot, 0, m.seed);
  const int book = in_slot < left ? slot - 1 : slot;
  const float right = kPitch + 0.012f * cell_value(slot + 1, 0, m.seed);
  const float to_border = std::min(std::abs(in_slot - left), std::abs(right - in_slot));
  const float height = 2.0f * p.half_height;
  const float y = (p.v + p.half_height) / height;
  const Colour cover = palette(hash_cell(book, 1, m.seed)) * (0.7f + cell_value(book, 2, m.seed));
  if (y > 0.82f + 0.18f * cell_value(book, 3, m.seed)) return Colour::Constant(0.012f);
  Colour colour =
      cover * (1.0f + 0.3f * fractal_noise(p.u, p.v, 0.02f, 1.0f, p.footprint, m.seed, 3));
  const float band = 0.25f + 0.4f * cell_value(book, 4, m.seed);
  if (std::abs(y - band) < 0.05f) colour = palette(hash_cell(book, 5, m.seed));
  if (y > 0.12f && y < 0.7f && std::abs(y - band) > 0.08f) {
    const float ink = letters(0.7f * height - p.v - p.half_height, in_slot, 0.02f, p.footprint,
                              m.seed + static_cast<std::uint32_t>(book));
    colour = mix(colour, Colour(0.5f, 0.65f, 0.7f), 0.8f * ink);
  }
  return colour * (to_border < 0.0025f ? 0.35f : 1.0f);
}

Colour screen(const Material& m, const SurfacePoint& p) {
  const float x = p.u + p.half_width;
  const float y = p.half_height - p.v;
  if (std::min(p.half_width - std::abs(p.u), p.half_height - std::abs(p.v)) < 0.015f) {
    return Colour::Constant(0.015f);
  }
  if (y < 0.035f) return palette(m.seed);
  const Colour base(0.06f, 0.04f, 0.035f);
  const int line = floor_int(y / 0.014f);
  const float indent = 0.03f + 0.02f * static_cast<float>(hash_cell(line / 3, 1, m.seed) % 4);
  const float end = indent + 0.4f * p.half_width * (0.5f + cell_value(line, 2, m.seed) * 2.0f);
  if (x > end) return base;
  const float ink = letters(x - indent, y, 0.014f, p.footprint, m.seed + 1);
  return mix(base, palette(hash_cell(line, 3, m.seed)) + Colour::Constant(0.25f), ink);
}

Colour foliage(const Material& m, const SurfacePoint& p) {
  const float leaves = fractal_noise(p.u, p.v, 0.05f, 0.5f, p.footprint, m.seed, 4);
  const float veins = faded_noise(p.u, p.v, 0.008f, 0.03f, p.footprint, m.seed + 5);
  return mix(m.colour, m.second, 0.5f + 1.4f * leaves) * (1.0f + 0.3f * veins);
}

Colour cardboard(const Material& m, const SurfacePoint& p) {
  const float fibres = fractal_noise(p.u, p.v, 0.02f, 4.0f, p.footprint, m.seed, 4);
  Colour colour = m.colour * (1.0f + 0.18f * fibres);
  if (std::abs(p.u) < 0.025f) colour = mix(colour, Colour(0.35f, 0.45f, 0.5f), 0.6f);
  const float print = p.v < -0.02f && p.u > 0.04f
                          ? letters(p.u - 0.04f, -p.v - 0.02f, 0.028f, p.footprint, m.seed + p.face)
                          : 0.0f;
  return mix(colour, Colour(0.03f, 0.04f, 0.06f), 0.8f * print);
}

}  // namespace

Eigen::Vector3f albedo(const Material& material, const SurfacePoint& at) {
  switch (material.pattern) {
    case Pattern::plaster:
      return plaster(material, at);
    case Pattern::wood:
      return wood(material, at);
    case Pattern::planks:
      return planks(material, at);
    case Pattern::bricks:
      return bricks(material, at);
    case Pattern::tiles:
      return tiles(material, at);
    case Pattern::fabric:
      return fabric(material, at);
    case Pattern::carpet:
      return carpet(material, at);
    case Pattern::speckle:
      return speckle(material, at);
    case Pattern::poster:
      return poster(material, at);
    case Pattern::text:
      return text(material, at);
    case Pattern::books:
      return books(material, at);
    case Pattern::screen:
      return screen(material, at);
    case Pattern::foliage:
      return foliage(material, at);
    case Pattern::cardboard:
      return cardboard(material, at);
  }
  return material.colour;
}

}  // namespace rprr
