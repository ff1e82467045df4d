// SPDX-License-Identifier: BSD-3-Clause
#include "colour_gain.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rprr {
namespace {

constexpr int kRounds = 6;
constexpr float kTukey = 4.685f;      // 95% efficiency on Gaussian noise
constexpr float kLeastSpread = 1.0f;  // [grey levels] below is quantisation

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

float spread_of(const std::vector<ColourPair>& pairs, const ColourGain& gain,
                std::vector<float>& buffer) {
  buffer.clear();
  for (const ColourPair& pair : pairs) {
    buffer.push_back(std::abs(pair.y - gain.gain * pair.x - gain.offset));
  }
  return std::max(1.4826f * median(buffer), kLeastSpread);
}

void solve(const std::vector<ColourPair>& pairs, ColourGain& fit) {
  double w = 0.0, wx = 0.0, wy = 0.0, wxx = 0.0, wxy = 0.0;
  const float reach = kTukey * fit.spread;
  for (const ColourPair& pair : pairs) {
    const float r = (pair.y - fit.gain * pair.x - fit.offset) / reach;
    if (!(std::abs(r) < 1.0f)) continue;
    const double weight = static_cast<double>((1.0f - r * r) * (1.0f - r * r));
    w += weight;
    wx += weight * pair.x;
    wy += weight * pair.y;
    wxx += weight * pair.x * pair.x;
    wxy += weight * pair.x * pair.y;
  }
  if (!(w > 0.0)) return;
  const double variance = wxx - wx * wx / w;
  // Colours of nearly one level tell an offset, no gain.
  if (variance > 25.0 * w) {
    fit.gain = std::clamp(static_cast<float>((wxy - wx * wy / w) / variance), 0.25f, 4.0f);
  }
  fit.offset = static_cast<float>((wy - static_cast<double>(fit.gain) * wx) / w);
}

}  // namespace

float ColourGain::apply(float x) const {
  return std::clamp(gain * x + offset, 0.0f, 255.0f);
}

ColourGain fit_colour_gain(const std::vector<ColourPair>& pairs, std::vector<float>& buffer) {
  ColourGain fit;
  if (pairs.empty()) return fit;
  // Exposure is mostly a factor: the median ratio is a start that outliers do not move.
  buffer.clear();
  for (const ColourPair& pair : pairs) buffer.push_back((pair.y + 1.0f) / (pair.x + 1.0f));
  fit.gain = std::clamp(median(buffer), 0.25f, 4.0f);
  for (int round = 0; round < kRounds; ++round) {
    fit.spread = spread_of(pairs, fit, buffer);
    solve(pairs, fit);
  }
  fit.spread = spread_of(pairs, fit, buffer);
  return fit;
}

}  // namespace rprr
