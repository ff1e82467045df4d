// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// What the robot tells the station about the exchange, for PairStatistics.
struct FrameReport {
  std::uint16_t blocks_predicted = 0;         // |B_p|
  std::uint16_t blocks_validated = 0;         // |B_v|
  std::uint32_t bytes_pose = 0;               // pose messages both ways, serialised
  std::uint32_t bytes_masks = 0;              // block masks both ways, serialised
  std::uint32_t independent_bytes_depth = 0;  // whole frame, same codec; 0: not measured
  std::uint32_t independent_bytes_colour = 0;
  float ms_pose = 0.0f;
  float ms_predict = 0.0f;
  float ms_validate = 0.0f;
  float ms_encode = 0.0f;
};

/// Where the blocks of a sparse frame stand in its colour image.
enum class ColourLayout : std::uint8_t {
  kInPlace,  // an image of the camera's size, meaningful in the mask's blocks
  kCompact,  // the mask's blocks moved together (compact_layout.hpp)
};

/// The base of a sparse frame is its whole colour image, coarser: ceil(width / reduction) by
/// ceil(height / reduction) pixels, each the mean of its cell.
constexpr bool is_base_reduction(int reduction) {
  return reduction == 1 || reduction == 2 || reduction == 4 || reduction == 8 || reduction == 16;
}

/// One RGB-D frame as it crosses the radio: whole, or the blocks that the station cannot derive
/// from a reference frame.
struct EncodedFrame {
  Camera camera;  // of this frame's images
  bool sparse = false;
  std::string reference;             // sparse: robot whose frame the station predicts from
  Stamp reference_stamp = 0;         // sparse: stamp of that frame
  Pose b_from_a = Pose::Identity();  // sparse: from the reference's camera to this one, M_ab
  BlockMask mask;                    // sparse: the blocks sent; empty otherwise
  BlockMask depth_mask;              // sparse: of these, the ones with depth; empty: all of them
  bool depth_rounded = false;        // to steps of inverse depth, since the radio was too narrow
  Bytes depth;                       // DHC-M payload of the whole frame or of depth_blocks()
  std::string colour_codec;          // name for ColourDecoder
  /// Detail: the image, or of a sparse frame the mask's blocks; empty where no block's colour is
  /// sent but the base's.
  Bytes colour;
  ColourLayout colour_layout = ColourLayout::kInPlace;  // kCompact: sparse only
  std::string base_codec;                               // name for ColourDecoder
  Bytes base;              // sparse only; meaningful where there is no detail
  int base_reduction = 0;  // 0: no base; 1, 2, 4, 8, 16
  /// RMS of the base's coding error, grey levels, as its sender measured it: in eighths on the
  /// wire, at most 31.9. What the station needs to weigh the base against its prediction.
  float base_noise = 8.0f;
  FrameReport report;

  /// sparse: the blocks whose depth is sent, a subset of mask.
  const BlockMask& depth_blocks() const { return depth_mask.empty() ? mask : depth_mask; }
};

/// Serialised bytes by kind; extras is everything else in the container.
struct EncodedSizes {
  std::size_t mask = 0;
  std::size_t depth = 0;
  std::size_t colour = 0;  // detail
  std::size_t base = 0;
  std::size_t extras = 0;
  std::size_t total = 0;
};

/// The container: versioned, lengths checked, sealed with a CRC-32 (doc/encoded_frame.md).
Bytes serialise(const EncodedFrame& frame, EncodedSizes* sizes = nullptr);
/// Untrusted bytes to a frame whose numbers make sense (camera valid, motion rigid, masks of
/// the camera's grid, depth_mask within mask, base and layout as above). The payloads inside are
/// still untrusted.
Result<EncodedFrame> parse_encoded_frame(ByteView bytes, EncodedSizes* sizes = nullptr);

}  // namespace rprr
