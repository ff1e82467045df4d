// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "rprr_codec/encoded_frame.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// A frame on its way to the radio: what of it is to be sent, and from which reference the station
/// predicts the rest (rprr_msgs/OutgoingFrame). What the encoder is given.
struct OutgoingFrame {
  RgbdFramePtr frame;
  std::uint32_t exchange = 0;        ///< 0: none
  bool sparse = false;               ///< false: everything is sent
  std::string reason;                ///< not sparse: why, for people
  std::string reference;             ///< sparse: robot whose frame the station predicts from
  Stamp reference_stamp = 0;         ///< sparse: stamp of that frame
  Pose b_from_a = Pose::Identity();  ///< sparse: M_ab, reference to this camera
  BlockMask mask;                    ///< sparse: the blocks to send
  BlockMask depth_mask;              ///< sparse: of these, the ones to send with depth
  FrameReport report;                ///< of the stages before the encoder
};

/// What is to be encoded of the frame: camera, masks, reference and report, no payloads yet. whole:
/// everything of it, although it could be sent sparsely.
EncodedFrame frame_to_encode(const OutgoingFrame& outgoing, bool whole = false);

}  // namespace rprr
