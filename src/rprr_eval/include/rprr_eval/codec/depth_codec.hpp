// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// A lossless codec of 16-bit depth images as the evaluation sees it: ours and the peers alike.
/// Objects keep their buffers between frames, serve one thread and run on one. They are given their
/// own output only: peers are not checked against hostile bytes here.
class DepthCodec {
 public:
  virtual ~DepthCodec() = default;
  /// Codes an image. Precondition: it is a continuous CV_16UC1. Errors: false if it cannot be
  /// coded.
  virtual bool encode(const cv::Mat& counts, Bytes& coded) = 0;
  /// Into a continuous CV_16UC1 image of the size that was encoded.
  virtual bool decode(ByteView coded, cv::Mat& counts) = 0;
};

using DepthCodecResult = Result<std::unique_ptr<DepthCodec>>;

/// A codec by its name; a new one is a file in src/codecs and a line in src/codecs/registry.cpp.
struct DepthCodecEntry {
  std::string name;
  std::string description;
  std::optional<DhcmMode> ours;  // DHC-M's mode; nothing: a peer
  /// Errors: a peer that was not built in, and the package that it wants.
  std::function<DepthCodecResult()> make;
};
const std::vector<DepthCodecEntry>& depth_codecs();

struct NamedDepthCodec {
  std::string name;
  std::optional<DhcmMode> ours;
  std::unique_ptr<DepthCodec> codec;
};

/// Makes those of the names, in their order; all that can be made if there are none. `notes` takes
/// a line for each that was left out because it is not built in. Errors: an unknown name, and,
/// where names are given, one that cannot be made.
Result<std::vector<NamedDepthCodec>> make_depth_codecs(const std::vector<std::string>& names,
                                                       std::vector<std::string>& notes);

}  // namespace rprr
