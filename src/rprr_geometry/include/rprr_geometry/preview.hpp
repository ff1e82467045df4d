// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/block_grid.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/wire.hpp"

namespace rprr {

/// A frame in one depth and one colour for each 8x8 block.
struct BlockPreview {
  BlockGrid grid;         // of the full image
  double step = 0.004;    // of inverse depth, 1/metre
  cv::Mat inverse_depth;  // CV_16UC1, rows x columns of blocks, q = 1/z in steps; 0 = no reading
  cv::Mat bgr;            // CV_8UC3, rows x columns: each block's mean colour

  bool valid(int column, int row) const {
    return inverse_depth.at<std::uint16_t>(row, column) != 0;
  }
  /// 1/metre; 0 = no reading.
  double q(int column, int row) const {
    return inverse_depth.at<std::uint16_t>(row, column) * step;
  }
};

/// A block that has a depth, as a point.
struct PreviewPoint {
  Eigen::Vector3f position;  // of the block's centre, optical frame of its camera, metres
  cv::Vec3b bgr;
};
/// Row by row. Empty if the camera is of another size than the preview.
std::vector<PreviewPoint> preview_points(const BlockPreview& preview, const Camera& camera);

/// What preview depth is rounded to: about a Kinect's own step in inverse depth (2.85e-3 1/m).
constexpr double kPreviewStep = 0.004;

/// The preview of a frame. A block's depth stands for the surface that most of its readings belong
/// to: the mean of 1/z (a plane is linear in it) over the readings near their median, never a mean
/// across an edge; blocks with few readings have none. bgr: CV_8UC3 of the frame's size;
/// of anything else all colours are grey.
BlockPreview make_preview(const DepthFrame& depth, const cv::Mat& bgr, double step = kPreviewStep);

/// Wire form, sealed with a CRC-32. Version 1:
///   u8 version, u16 image width, u16 image height, f32 step, u8 colour quality, u32 length of
///   depth, depth: range-coded residuals of the inverse depths; colour: WebP of the colours as an
///   image.
/// About 2.5 kB for VGA. colour_quality: WebP's, 0 to 100.
Bytes encode_preview(const BlockPreview& preview, int colour_quality);

/// Errors: anything malformed; an image larger than kMaxImageSide a side.
Result<BlockPreview> decode_preview(ByteView bytes);

}  // namespace rprr
