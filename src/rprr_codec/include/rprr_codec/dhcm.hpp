// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <string>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Where an encoder stands between speed and size. All modes write one format, which every decoder
/// reads without being told.
enum class DhcmMode : std::uint8_t { kFast, kDefault, kSmall };

/// "fast", "default" or "small"; anything else is an error.
Result<DhcmMode> dhcm_mode_from_name(const std::string& name);
const char* dhcm_mode_name(DhcmMode mode);

/// What the pixels of a payload were before they were coded.
enum class DhcmPixels : std::uint8_t {
  kCounts,          // 16UC1 counts of a unit
  kFloat,           // 32FC1, bit by bit
  kQuantisedFloat,  // 32FC1 in metres, rounded to a step: lossy by no more than half a step
};

/// What a payload says of itself.
struct DhcmInfo {
  int version = 0;
  DhcmMode mode = DhcmMode::kDefault;  // as which it was encoded
  DhcmPixels pixels = DhcmPixels::kCounts;
  bool masked = false;  // only the blocks of a mask that is not in the payload
  bool stored = false;  // not compressed: noise
  int width = 0;
  int height = 0;
  double unit = 0.001;  // metres per count; kQuantisedFloat: the step
};
/// Checks the checksum and the header, not the pixels.
Result<DhcmInfo> dhcm_info(ByteView payload);

/// No payload of an image of this size is longer: what to size buffers and queues by.
std::size_t dhcm_bound(cv::Size size, DhcmPixels pixels = DhcmPixels::kCounts);

/// Lossless depth coding: differential, Huffman, with several lookup tables (the paper's DHC-M, in
/// our own bit format: doc/dhcm.md). The payload carries size, unit, version and a CRC-32. An
/// encoder keeps its buffers between frames; one object serves one thread.
class DhcmEncoder {
 public:
  explicit DhcmEncoder(DhcmMode mode = DhcmMode::kDefault);
  ~DhcmEncoder();

  /// For the frames to come.
  void set_mode(DhcmMode mode) { mode_ = mode; }
  DhcmMode mode() const { return mode_; }

  /// The whole frame (16UC1 counts): 1 to kMaxImageSide (8192) pixels a side.
  Bytes encode(const DepthFrame& frame);
  /// Only the blocks of the mask, which has the frame's grid; the mask itself is not in the
  /// payload.
  Bytes encode(const DepthFrame& frame, const BlockMask& blocks);

  /// A 32FC1 image in metres. Step 0: lossless, every bit pattern comes back (NaN, infinities,
  /// negative numbers and all). Else readings are rounded to whole steps (metres), and what is not
  /// finite or not positive comes back as NaN, which is REP-118's "no reading"; the payload states
  /// the step. Errors: not 32FC1, no such size, a step that is negative or not finite, a reading
  /// that rounds to 0 or to more than 65535 steps (never silently clipped).
  Result<Bytes> encode_float(const cv::Mat& metres, double step);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
  DhcmMode mode_;
};

/// Reads what DhcmEncoder wrote. Any other bytes are an error, never a crash, an over-read or an
/// allocation beyond what max_pixels allows. Memory is that of the largest frame so far.
class DhcmDecoder {
 public:
  explicit DhcmDecoder(std::size_t max_pixels = std::size_t{64} * 1024 * 1024);
  ~DhcmDecoder();

  /// Payloads of DhcmPixels::kCounts; others are errors here.
  Result<DepthFrame> decode(ByteView payload);
  /// The same, where another size than the expected one is an error before anything is allocated.
  /// reuse is memory for the image where it fits, as of a frame that is no longer needed: what it
  /// showed is overwritten, also by payloads that turn out to be malformed.
  Result<DepthFrame> decode(ByteView payload, cv::Size expected, const cv::Mat& reuse = {});
  /// A payload that was encoded with this mask; pixels of other blocks are 0.
  Result<DepthFrame> decode(ByteView payload, const BlockMask& blocks);

  /// Payloads of encode_float: a 32FC1 image in metres. kCounts payloads are errors here.
  Result<cv::Mat> decode_float(ByteView payload);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
  std::size_t max_pixels_;
};

}  // namespace rprr
