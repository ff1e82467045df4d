// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "rprr_geometry/stamp.hpp"
#include "rprr_pose/exchange.hpp"
#include "rprr_pose/pose_prior.hpp"
#include "rprr_pose/preview_pose.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {

/// Settings of the `preview` protocol: b sends one small message for each frame, a answers with the
/// pose, or why there is none.
struct PreviewOptions {
  double step = 0.003;          // dependent: of inverse depth in the preview, 1/metre
  bool lossless_depth = false;  // dependent: readings of the sensor, unchanged, instead of steps
  int colour_quality = 40;      // dependent: of the preview's colours, WebP's 0 to 100
  PreviewPoseOptions search;    // reference
  /// Dependent: for a's answer. Reference: half of it is for a frame near b's in time to come; then
  /// it says that there is none.
  Duration step_timeout = from_seconds(1.0);
  Duration min_period = 0;                             // dependent: between previews
  Duration max_stamp_difference = from_seconds(0.05);  // reference: between the robots' frames
  std::size_t frames_kept = 30;                        // reference: recent frames to choose from
  /// Reference: while its radio is busy it refers to a frame that it sent not longer than this ago,
  /// and where no frame is near b's in time to the nearest it has. 0: only to frames near in time.
  Duration reference_age = from_seconds(10.0);
  std::uint32_t first_exchange = 1;  // dependent: number of the first exchange, not 0
};

/// Robot self as the reference of one peer: a Director (director.hpp) that answers the peer alone.
/// prior may be empty.
std::unique_ptr<ExchangeRole> make_preview_reference(const std::string& self,
                                                     const std::string& peer,
                                                     const PreviewOptions& options,
                                                     PosePrior prior = {});
/// Robot self as the dependent of one peer: sends it previews of its own frames.
std::unique_ptr<ExchangeRole> make_preview_dependent(const std::string& self,
                                                     const std::string& peer,
                                                     const PreviewOptions& options);

/// Content of rprr_msgs/BlockPreview: u8 version 1, u8 flags (bit 0: camera present), u32 hash of
/// the sender's camera, u32 hash of the receiver's camera that the sender knows (0: none), camera
/// (20 bytes) if present, then the sealed preview of rprr_wire/preview.hpp. The first part is
/// not sealed by itself: a wrong hash costs the exchange, nothing else.
struct PreviewContent {
  std::uint32_t camera_hash = 0;
  std::uint32_t known_peer_hash = 0;
  std::optional<Camera> camera;
  Bytes preview;
};
Bytes encode_preview_content(const PreviewContent& content);
/// Errors: malformed. The preview inside is still untrusted.
Result<PreviewContent> decode_preview_content(ByteView bytes);

}  // namespace rprr
