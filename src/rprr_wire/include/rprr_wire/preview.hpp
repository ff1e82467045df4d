// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "rprr_geometry/block_grid.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// What a preview's depths count.
enum class PreviewDepth : std::uint8_t {
  kInverse = 0,  // steps of inverse depth: rounded
  kCounts = 1,   // the sensor's own counts: each is a reading of its block, unchanged
};

/// A frame in one depth and one colour for each 8x8 block.
struct BlockPreview {
  BlockGrid grid;  // of the full image
  PreviewDepth coding = PreviewDepth::kInverse;
  double step = 0.004;  // of what depth counts: 1/metre (kInverse) or metres (kCounts)
  cv::Mat depth;        // CV_16UC1, rows x columns of blocks, in steps; 0 = no reading
  cv::Mat bgr;          // CV_8UC3, rows x columns: each block's mean colour

  bool valid(int block) const { return depth.ptr<std::uint16_t>()[block] != 0; }
  bool valid(int column, int row) const { return valid(grid.index(column, row)); }
  /// Inverse depth, 1/metre; 0 = no reading.
  double q(int block) const {
    const double scaled = depth.ptr<std::uint16_t>()[block] * step;
    return coding == PreviewDepth::kInverse || scaled == 0.0 ? scaled : 1.0 / scaled;
  }
  double q(int column, int row) const { return q(grid.index(column, row)); }
  /// Depth; 0 = no reading.
  double metres(int block) const {
    const double scaled = depth.ptr<std::uint16_t>()[block] * step;
    return coding == PreviewDepth::kCounts || scaled == 0.0 ? scaled : 1.0 / scaled;
  }
  /// How far apart, in metres, two depths around z are that the preview can just tell apart.
  double resolution(double z) const {
    return coding == PreviewDepth::kInverse ? step * z * z : step;
  }
  /// Whether sizes and types are as stated: to be asked of a preview from elsewhere.
  bool well_formed() const;
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

/// Likewise with lossless depth: of each block the reading that is nearest to that mean.
BlockPreview make_exact_preview(const DepthFrame& depth, const cv::Mat& bgr);

/// Wire form, sealed with a CRC-32. Version 2:
///   u8 version, u16 image width, u16 image height, u8 coding of depth (bit 0: PreviewDepth, bit 1:
///   ranks in a table of the depths that occur), f32 step, u32 length of depth, depth (see
///   doc/preview.md), colour: WebP of the colours as an image without what its headers repeat.
/// About 2 kB for VGA. colour_quality: WebP's, 0 to 100.
Bytes encode_preview(const BlockPreview& preview, int colour_quality);

/// Errors: anything malformed, another version; an image larger than kMaxImageSide a side.
Result<BlockPreview> decode_preview(ByteView bytes);

/// What depth and colour take of a wire form; 0 of anything malformed.
std::size_t preview_depth_bytes(ByteView bytes);
std::size_t preview_colour_bytes(ByteView bytes);

}  // namespace rprr
