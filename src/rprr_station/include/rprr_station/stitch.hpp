// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_station/smooth_fill.hpp"
#include "rprr_station/view_synthesis.hpp"

namespace rprr {

/// What colour a pixel gets that was neither received nor predicted.
enum class UnknownFill { kBlack /* the paper's pictures */, kSmooth };

/// The dependent's frame as the station can know it.
struct StitchedView {
  cv::Mat bgr;                   // CV_8UC3
  DepthFrame depth;              // counts of the dependent's own unit, 0 where nobody knows
  cv::Mat provenance;            // CV_8UC1, see Provenance
  double share_received = 0.0;   // of all pixels
  double share_predicted = 0.0;  // of all pixels, mended ones included
};

/// Lays received blocks over a prediction. Keeps its buffers between frames; one object serves one
/// thread.
class Stitcher {
 public:
  explicit Stitcher(UnknownFill fill = UnknownFill::kSmooth) : fill_(fill) {}

  /// Colours of the mask's blocks and depths of depth_mask's blocks come from the received images
  /// exactly as they are; the others from the prediction, depth rounded to the received depth's
  /// unit. Provenance is that of the colours. The images in the result are new memory. Errors:
  /// sizes or types that differ.
  Result<StitchedView> stitch(const PredictedView& predicted, const cv::Mat& received_bgr,
                              const DepthFrame& received_depth, const BlockMask& mask,
                              const BlockMask& depth_mask);

 private:
  UnknownFill fill_;
  SmoothFiller filler_;
};

}  // namespace rprr
