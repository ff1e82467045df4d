// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace rprr {

/// How one camera's colour channel shows in another's: y = gain x + offset, grey levels, up to a
/// robust standard deviation.
struct ColourGain {
  float gain = 1.0f;
  float offset = 0.0f;
  float spread = 0.0f;

  float apply(float x) const;  // clipped to 0..255, as the camera clips
};

struct ColourPair {
  float x;
  float y;
};

/// Iterated least squares with Tukey weights, so that what truly changed has no say.
/// buffer is scratch memory.
ColourGain fit_colour_gain(const std::vector<ColourPair>& pairs, std::vector<float>& buffer);

}  // namespace rprr
