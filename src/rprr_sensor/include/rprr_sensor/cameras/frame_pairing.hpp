// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "rprr_geometry/stamp.hpp"
#include "rprr_sensor/cameras/rgbd_device.hpp"

namespace rprr {

/// A colour and a depth image of one camera that belong together.
struct DevicePair {
  DeviceImage colour;
  DeviceImage depth;
  Stamp colour_stamp = 0;  // names the pair
  Stamp depth_stamp = 0;
};

/// Pairs the images of a camera's two streams, which run at their own pace. An image is used once;
/// one that finds no partner is dropped once its partner can no longer come.
class FramePairing {
 public:
  /// `window`: how far stamps of a pair may lie apart. At half of a frame's period or more no image
  /// of two steady streams is lost.
  explicit FramePairing(Duration window) : window_(window) {}

  /// Stamps of a kind should ascend; where they go back, as after a jump of the clock, what waits
  /// is dropped.
  std::optional<DevicePair> add(DeviceImage image, Stamp stamp);

  std::uint64_t unpaired() const { return unpaired_; }

 private:
  struct Waiting {
    DeviceImage image;
    Stamp stamp;
  };

  Duration window_;
  std::deque<Waiting> colour_;
  std::deque<Waiting> depth_;
  std::uint64_t unpaired_ = 0;
};

}  // namespace rprr
