// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/types.hpp>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/wire.hpp"

namespace rprr {

/// Lossless depth coding: differential, Huffman, with several lookup tables (the paper's DHC-M, in
/// our own bit format: doc/dhcm.md). The payload carries size, unit, version and a CRC-32. An
/// encoder keeps its buffers between frames; one object serves one thread.
class DhcmEncoder {
 public:
  DhcmEncoder();
  ~DhcmEncoder();

  /// The whole frame: 1 to kMaxImageSide pixels a side.
  Bytes encode(const DepthFrame& frame);
  /// Only the blocks of the mask, which has the frame's grid; the mask itself is not in the
  /// payload.
  Bytes encode(const DepthFrame& frame, const BlockMask& blocks);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

/// Reads what DhcmEncoder wrote. Any other bytes are an error, never a crash, an over-read or an
/// allocation beyond what max_pixels allows.
class DhcmDecoder {
 public:
  explicit DhcmDecoder(std::size_t max_pixels = std::size_t{64} * 1024 * 1024);
  ~DhcmDecoder();

  Result<DepthFrame> decode(ByteView payload);
  /// The same, where another size than the expected one is an error before anything is allocated.
  Result<DepthFrame> decode(ByteView payload, cv::Size expected);
  /// A payload that was encoded with this mask; pixels of other blocks are 0.
  Result<DepthFrame> decode(ByteView payload, const BlockMask& blocks);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
  std::size_t max_pixels_;
};

}  // namespace rprr
