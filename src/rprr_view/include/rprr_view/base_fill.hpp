// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_view/base_image.hpp"
#include "rprr_view/view_synthesis.hpp"

namespace rprr {

/// A column or row of a frame in a smaller image: between two pixels, and how far towards the
/// second.
struct SmallerPlace {
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
  void take_rows(const BaseImage& base, int v);
  Float4 sample_base(int u) const;

  std::vector<SmallerPlace> columns_, rows_;  // in the base
  std::vector<SmallerPlace> offset_columns_, offset_rows_;
  cv::Mat taken_;             // CV_32FC1, the base's two rows around a row of the frame
  float taken_share_ = 0.0f;  // of the second of them
  std::vector<cv::Mat> offsets_ = std::vector<cv::Mat>(1);  // CV_32FC4, each of half the size
};

}  // namespace rprr
