// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_view/stitch.hpp"

#include <cmath>
#include <opencv2/core.hpp>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_view/block_pixels.hpp"

namespace rprr {
namespace {

// Predicted metres as counts; 0 where there is nothing or where the unit cannot hold it.
void round_to_counts(const cv::Mat& metres, double unit, cv::Mat& counts) {
  counts.create(metres.size(), CV_16UC1);
  const auto per_metre = static_cast<float>(1.0 / unit);
  for (int v = 0; v < metres.rows; ++v) {
    const auto* in = metres.ptr<float>(v);
    auto* out = counts.ptr<std::uint16_t>(v);
    for (int u = 0; u < metres.cols; ++u) {
      const float rounded = in[u] * per_metre + 0.5f;
      out[u] = rounded < 65536.0f ? static_cast<std::uint16_t>(static_cast<int>(rounded))
                                  : std::uint16_t{0};
    }
  }
}

}  // namespace

Result<StitchedView> Stitcher::stitch(const PredictedView& predicted, const cv::Mat& received_bgr,
                                      const DepthFrame& received_depth, const BlockMask& mask,
                                      const BlockMask& depth_mask) {
  const BlockGrid& grid = mask.grid();
  const cv::Size size(grid.width, grid.height);
  const bool colours_fit =
      received_bgr.empty() || (received_bgr.size() == size && received_bgr.type() == CV_8UC3);
  if (predicted.bgr.size() != size || predicted.metres.size() != size ||
      predicted.provenance.size() != size || !colours_fit || received_depth.counts.size() != size ||
      received_depth.counts.type() != CV_16UC1 || !(received_depth.unit > 0) ||
      cv::Size(depth_mask.grid().width, depth_mask.grid().height) != size) {
    return Error{"prediction, received images and block masks are not of one size"};
  }
  StitchedView view;
  predicted.bgr.copyTo(view.bgr);
  predicted.provenance.copyTo(view.provenance);
  round_to_counts(predicted.metres, received_depth.unit, view.depth.counts);
  view.depth.unit = received_depth.unit;
  predicted_depth_.create(size, CV_8UC1);
  predicted_depth_.setTo(1);

  for (int block = 0; block < grid.count(); ++block) {
    const cv::Rect rect = grid.rect(block);
    if (mask[block] && !received_bgr.empty()) {
      copy_pixels(received_bgr, rect, view.bgr);
      set_pixels(view.provenance, rect, depth_mask[block] ? kReceived : kReceivedColour);
    }
    if (depth_mask[block]) {
      if (received_bgr.empty()) set_pixels(view.provenance, rect, kReceivedDepth);
      copy_pixels(received_depth.counts, rect, view.depth.counts);
      set_pixels(predicted_depth_, rect, 0);
    }
  }
  depth_edges_.clear(view.depth.counts, predicted_depth_);

  const double pixels = static_cast<double>(size.area());
  const int received = cv::countNonZero(view.provenance >= kReceivedColour);
  const int base =
      cv::countNonZero((predicted.provenance == kBase) & (view.provenance < kReceivedColour));
  const int known = cv::countNonZero(view.provenance);
  view.share_received = received / pixels;
  view.share_predicted = (known - received - base) / pixels;
  view.share_base = base / pixels;
  if (options_.fill == UnknownFill::kSmooth && known < size.area()) {
    filler_.fill(view.bgr, view.provenance);
    view.provenance.setTo(kFilled, view.provenance == kNothing);
  }
  return view;
}

}  // namespace rprr
