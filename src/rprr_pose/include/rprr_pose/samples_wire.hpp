// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_pose/sampling.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {

/// Content of rprr_msgs/SamplePoints, sealed with a CRC-32:
///   u8 version: 1 narrow points (10 bits column, 9 bits row, 16 bits depth: the paper's 35), for
///               images up to 1024x512; 2 wide points (13, 13, 16 bits)
///   u8 flags: bit 0 camera present, bit 1 normals present
///   u8 iteration
///   u32 hash of the sender's camera, u32 hash of the receiver's camera that the sender knows (0:
///   none) camera (20 bytes, camera.hpp) if present f32 unit, u16 count points, bit-packed from the
///   least significant bit, padded to a byte: 250 narrow ones are 1094 bytes normals if present:
///   two bytes each, octahedral, 8 bits a coordinate
struct SamplesContent {
  std::uint8_t iteration = 0;
  std::uint32_t camera_hash = 0;
  std::uint32_t known_peer_hash = 0;
  std::optional<Camera> camera;
  bool with_normals = false;
  double unit = 0.001;
  std::vector<SamplePoint> points;
};

Bytes encode_samples(const SamplesContent& content, int image_width, int image_height);
/// Whether the samples say that a dependent sent them, which has normals. Untrusted: nothing else
/// was looked at.
bool are_of_dependent(ByteView bytes);
/// Errors: anything malformed. Columns and rows are only known to fit their bits: check them
/// against the camera.
Result<SamplesContent> decode_samples(ByteView bytes);

}  // namespace rprr
