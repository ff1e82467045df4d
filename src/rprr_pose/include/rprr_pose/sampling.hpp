// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"

namespace rprr {

/// One measurement of a depth image as it crosses the radio: p_{l,a} or p_{k,b} of the paper.
struct SamplePoint {
  std::uint16_t column = 0;
  std::uint16_t row = 0;
  std::uint16_t counts = 0;  // depth in the frame's unit, never 0
  /// Surface normal in the sender's optical frame, towards the camera; zero if it is not known.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

/// The paper's N_a = N_b.
constexpr int kSampleCount = 250;

/// Up to `count` valid pixels spread evenly over the image (an R2 low-discrepancy sequence that
/// starts where `seed` says), each with its surface normal; pixels without a usable normal are
/// passed over as long as there are others. Fewer points come back from a frame with little depth.
std::vector<SamplePoint> sample_points(const DepthFrame& frame, const Camera& camera, int count,
                                       std::uint32_t seed);

}  // namespace rprr
