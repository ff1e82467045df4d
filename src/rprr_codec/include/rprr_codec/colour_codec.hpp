// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// A codec and its own scale of quality: whole numbers from best to coarsest, whichever is larger.
/// Bytes and error go the same way along it, so that a rate can be found by halving.
struct ColourCodecInfo {
  std::string name;
  int best = 0;
  int coarsest = 0;

  bool has_quality(int quality) const {
    return best < coarsest ? best <= quality && quality <= coarsest
                           : coarsest <= quality && quality <= best;
  }
};

/// Encodes 8-bit BGR images (CV_8UC3). One object serves one thread.
class ColourEncoder {
 public:
  virtual ~ColourEncoder() = default;
  /// Name by which the decoder is found.
  virtual std::string name() const = 0;
  /// The payload, sealed with a CRC-32. quality is on the codec's own scale. Errors: another type
  /// of image, one without pixels or beyond kMaxImageSide, a quality out of range.
  virtual Result<Bytes> encode(const cv::Mat& bgr, int quality) = 0;
  /// Whether it spends least on blocks of 8x8 pixels that are of one colour, or on a smooth slope.
  virtual bool prefers_flat_blocks() const { return false; }
};

/// Decodes untrusted payloads of any codec that this build knows. One object serves one thread.
class ColourDecoder {
 public:
  virtual ~ColourDecoder() = default;
  /// An image of exactly the expected size, or an error.
  virtual Result<cv::Mat> decode(const std::string& codec, ByteView payload, cv::Size expected) = 0;
};

/// The image size that a payload of a codec states, for a decoder that was not told it otherwise:
/// 1 to kMaxImageSide pixels a side. Errors: damaged, unknown. The pixels are not looked at.
Result<cv::Size> colour_payload_size(const std::string& codec, ByteView payload);

/// How often the resolution of what a payload holds is halved against the size that it states: 0,
/// or more if it was cut. Errors as above.
Result<int> colour_payload_coarse(const std::string& codec, ByteView payload);

/// Resolutions of a pgf payload: it decodes at any coarse below this (at least 1).
Result<int> pgf_levels(ByteView payload);
/// A pgf payload without the finest levels, sealed anew: it decodes to an image of the full size,
/// interpolated from the one halved coarse times. Errors: damaged, fewer levels than that, a
/// payload that is coarser already. coarse 0 changes nothing.
Result<Bytes> pgf_cut(ByteView payload, int coarse);

/// Names that make_colour_encoder takes: pgf, jpeg, webp.
std::vector<std::string> colour_codecs();
/// pgf: 0 lossless, 1 finest, 30 coarsest. jpeg: 100 to 1. webp: 100 to 0. Error: unknown name.
Result<ColourCodecInfo> colour_codec_info(const std::string& codec);
/// Error: unknown name.
Result<std::unique_ptr<ColourEncoder>> make_colour_encoder(const std::string& codec);

/// Decodes in this process: for payloads of our own making only. libpgf crashes on hostile bytes.
std::unique_ptr<ColourDecoder> make_local_colour_decoder();

/// Limits of the worker process that decodes what came over a radio.
struct WorkerLimits {
  double seconds = 2.0;  // wall clock for one image; then the worker is killed
  std::size_t memory = std::size_t{512} << 20;  // address space, bytes
};
/// Decodes in a child process that is restarted when it dies, hangs or exceeds its limits; hostile
/// bytes cost one error. The worker executable is found beside the installed package or by
/// RPRR_COLOUR_WORKER; the error of the first decode says so if it is missing.
std::unique_ptr<ColourDecoder> make_isolated_colour_decoder(const WorkerLimits& limits = {});

}  // namespace rprr
