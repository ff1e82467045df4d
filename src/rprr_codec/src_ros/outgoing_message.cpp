// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec_ros/outgoing_message.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "rprr_ros/conversions.hpp"
#include "rprr_ros/frame_message.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

std::uint16_t narrow(std::uint32_t count) {
  return static_cast<std::uint16_t>(
      std::min<std::uint32_t>(count, std::numeric_limits<std::uint16_t>::max()));
}

FrameReport report_of(const rprr_msgs::OutgoingFrame& message) {
  FrameReport report;
  report.blocks_predicted = narrow(message.blocks_predicted);
  report.blocks_validated = narrow(message.blocks_validated);
  report.bytes_masks = message.mask_bytes;
  report.bytes_pose = message.pose_bytes;
  report.ms_pose = message.ms_pose;
  report.ms_predict = message.ms_predict;
  report.ms_validate = message.ms_validate;
  return report;
}

// Fills what only a sparse frame has. Empty where it makes sense, else what does not.
std::string read_reference(const rprr_msgs::OutgoingFrame& message, const RgbdFrame& frame,
                           OutgoingFrame& outgoing) {
  if (message.reference.empty()) return "sparse frame names no reference robot";
  outgoing.reference = message.reference;
  outgoing.reference_stamp = to_stamp(message.reference_stamp);
  outgoing.b_from_a = pose_from_fields(message.translation, message.rotation);
  if (!is_rigid(outgoing.b_from_a)) return "sparse frame with a pose that is not rigid";
  const BlockGrid grid(frame.camera.width, frame.camera.height);
  Result<BlockMask> mask = decode_mask(message.mask, grid);
  if (!mask) return mask.reason();
  Result<BlockMask> depth_mask = decode_mask(message.depth_mask, grid);
  if (!depth_mask) return "depth mask: " + depth_mask.reason();
  outgoing.mask = std::move(*mask);
  outgoing.depth_mask = std::move(*depth_mask);
  return {};
}

}  // namespace

rprr_msgs::OutgoingFrame to_message(const OutgoingFrame& outgoing) {
  rprr_msgs::OutgoingFrame message;
  if (outgoing.frame) message.frame = to_message(*outgoing.frame);
  message.exchange = outgoing.exchange;
  message.sparse = outgoing.sparse;
  message.blocks_predicted = outgoing.report.blocks_predicted;
  message.blocks_validated = outgoing.report.blocks_validated;
  message.pose_bytes = outgoing.report.bytes_pose;
  message.mask_bytes = outgoing.report.bytes_masks;
  message.ms_pose = outgoing.report.ms_pose;
  message.ms_predict = outgoing.report.ms_predict;
  message.ms_validate = outgoing.report.ms_validate;
  pose_to_fields(outgoing.b_from_a, message.translation, message.rotation);
  if (!outgoing.sparse) return message;
  message.reference = outgoing.reference;
  message.reference_stamp = to_time(outgoing.reference_stamp);
  message.mask = encode_mask(outgoing.mask);
  message.depth_mask = encode_mask(outgoing.depth_mask);
  return message;
}

void from_message(const rprr_msgs::OutgoingFrame& message, OutgoingFrame& outgoing) {
  outgoing = OutgoingFrame();
  outgoing.exchange = message.exchange;
  outgoing.sparse = message.sparse != 0;
  outgoing.report = report_of(message);
  const Result<RgbdFramePtr> frame = frame_from_message(message.frame);
  const std::string wrong = !frame            ? frame.reason()
                            : outgoing.sparse ? read_reference(message, **frame, outgoing)
                                              : std::string();
  outgoing.reason = wrong;
  if (wrong.empty()) outgoing.frame = *frame;
}

}  // namespace rprr
