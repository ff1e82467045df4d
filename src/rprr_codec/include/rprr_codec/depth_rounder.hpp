// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// Rounds depth to steps of inverse depth, in which a triangulating sensor's own are about even: an
/// error of at most half a step of 1/z, so of z^2 times that in metres. No reading stays none.
/// Keeps its table and image between frames; one object serves one thread.
class DepthRounder {
 public:
  /// step: 1/metre, above 0. The result is valid until the next call.
  const DepthFrame& round(const DepthFrame& depth, double step);

 private:
  void make_table(double unit, double step);

  double unit_ = 0.0;
  double step_ = 0.0;
  std::vector<std::uint16_t> table_;  // of all counts
  DepthFrame rounded_;
};

}  // namespace rprr
