// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"

namespace rprr {

/// Frames of a folder, read once and kept. At most `kept` at a time: the one longest in goes first.
class FrameSource {
 public:
  explicit FrameSource(TumFolder folder, std::size_t kept = 256)
      : folder_(std::move(folder)), kept_(kept) {}

  const TumFolder& folder() const { return folder_; }
  /// Errors: images that cannot be read.
  Result<RgbdFramePtr> frame(std::size_t entry);

 private:
  TumFolder folder_;
  std::size_t kept_;
  std::map<std::size_t, RgbdFramePtr> frames_;
  std::vector<std::size_t> order_;
};

using FramePair = std::pair<RgbdFramePtr, RgbdFramePtr>;  // a, b

/// Pairs (k, k + step) of a folder, at most so many, spread evenly.
Result<std::vector<FramePair>> folder_pairs(FrameSource& source, std::size_t step,
                                            std::size_t most);

/// Two robots walking side by side through the synthetic room, from the package rprr_sensor.
std::vector<FramePair> synthetic_pairs(int count, std::uint32_t seed);

}  // namespace rprr
