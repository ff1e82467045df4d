// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Bytes of a camera on the wire: u16 width, u16 height, f32 fx, fy, cx, cy.
constexpr std::size_t kCameraBytes = 20;
void put_camera(ByteWriter& writer, const Camera& camera);
/// Refuses what valid() refuses.
Result<Camera> get_camera(ByteReader& reader);

/// The camera as it comes out of the wire (intrinsics rounded to float32): both ends must compute
/// with this one.
Camera rounded_for_wire(const Camera& camera);

/// Short name of a camera's wire bytes (their CRC-32); never 0, which stands for "not known".
std::uint32_t camera_hash(const Camera& camera);

}  // namespace rprr
