// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_view/depth_edges.hpp"
#include "rprr_view/smooth_fill.hpp"
#include "rprr_view/view_synthesis.hpp"

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
  double share_base = 0.0;       // of all pixels: those that only the base knows
};

struct StitchOptions {
  UnknownFill fill = UnknownFill::kSmooth;
  /// Predicted depth is dropped within so many pixels of a depth edge; 0: never, as in the paper.
  int edge_margin = 2;
};

/// Lays received blocks over a prediction. Keeps its buffers between frames; one object serves one
/// thread.
class Stitcher {
 public:
  explicit Stitcher(StitchOptions options = {})
      : options_(options), depth_edges_(options.edge_margin) {}

  /// received_bgr may be empty: then only depth was received. Colours of the mask's blocks and
  /// depths of depth_mask's blocks come from the received images exactly as they are; the others
  /// from the prediction, depth rounded to the received depth's unit and only where no depth edge
  /// is near. Provenance is that of the colours. The images in the result are new memory. Errors:
  /// sizes or types that differ.
  Result<StitchedView> stitch(const PredictedView& predicted, const cv::Mat& received_bgr,
                              const DepthFrame& received_depth, const BlockMask& mask,
                              const BlockMask& depth_mask);

 private:
  StitchOptions options_;
  DepthEdges depth_edges_;
  SmoothFiller filler_;
  cv::Mat predicted_depth_;  // CV_8UC1, 1 where depth is predicted
};

}  // namespace rprr
