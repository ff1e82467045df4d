// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "rprr_geometry/result.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_pose/normal_equations.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {

/// Content of rprr_msgs/PoseUpdate, sealed with a CRC-32. Common: u8 version 1, u8 kind, u8
/// iteration. Kind 0, from the reference: f32 translation x y z, f32 quaternion x y z w of M_ab,
/// f32 c, u8 flags (bit 0: weigh by noise as well), u8 iteration in which the points to match were
/// sent.
struct PoseRequest {
  std::uint8_t iteration = 0;
  Pose b_from_a = Pose::Identity();
  double c = 0.0;
  bool by_noise = true;
  std::uint8_t points_iteration = 0;  // use the points sent in this iteration
};
/// Kind 1, from the dependent: upper triangle of K^T W K (21 f32, row by row), K^T W y (6 f32),
/// sums of w r^2, w, r^2 / variance and |z_a - z_b| (4 f32), points, in view, matched, consistent,
/// violating (5 u16).
struct PoseHalf {
  std::uint8_t iteration = 0;
  NormalEquations equations;
};

Bytes encode_request(const PoseRequest& request);
Bytes encode_half(const PoseHalf& half);
/// Whether the update says that it is a half, from a dependent. Untrusted: nothing else was looked
/// at.
bool is_of_dependent(ByteView bytes);
/// The motion as the receiver will have it: the sender iterates with this one too.
Pose rounded_for_wire(const Pose& pose);

/// Errors: anything malformed, of the other kind, not finite or not possible.
Result<PoseRequest> decode_request(ByteView bytes);
Result<PoseHalf> decode_half(ByteView bytes);

}  // namespace rprr
