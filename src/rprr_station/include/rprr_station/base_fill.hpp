// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_station/base_image.hpp"
#include "rprr_station/view_synthesis.hpp"

namespace rprr {

/// A column or row of a frame in its base: between two pixels (times three, for their colours), and
/// how far towards the second.
struct BasePlace {
  int first;
  int second;
  float share;
};

/// Colours from the base for pixels that were not predicted, in the light of the prediction around
/// them: so the prediction has no edges where it begins and ends, and what is compared with the
/// base afterwards brings the base's own light back. Keeps its buffers between frames; one object
/// serves one thread.
class BaseFill {
 public:
  /// Pixels of provenance kNothing get a colour and provenance kBase. base must fit the view.
  void fill(const BaseImage& base, PredictedView& view);

 private:
  using Float4 = float __attribute__((vector_size(16)));

  void measure_offsets(const BaseImage& base, const PredictedView& view);
  Float4 sample_base(const BaseImage& base, int u, int v) const;

  std::vector<BasePlace> columns_, rows_;
  std::vector<cv::Mat> offsets_ = std::vector<cv::Mat>(1);  // CV_32FC4, each of half the size
};

}  // namespace rprr
