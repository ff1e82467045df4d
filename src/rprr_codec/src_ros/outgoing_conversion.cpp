// SPDX-License-Identifier: BSD-3-Clause
#include "outgoing_conversion.hpp"

#include <algorithm>
#include <limits>

#include "rprr_ros/conversions.hpp"
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
  report.bytes_pose = message.exchange_bytes - std::min(message.exchange_bytes, message.mask_bytes);
  report.ms_pose = message.ms_pose;
  report.ms_predict = message.ms_predict;
  report.ms_validate = message.ms_validate;
  return report;
}

// Fills what only a sparse frame has. Empty where it makes sense, else what does not.
std::string add_reference(const rprr_msgs::OutgoingFrame& message, EncodedFrame& frame) {
  if (message.reference.empty()) return "sparse frame names no reference robot";
  frame.reference = message.reference;
  frame.reference_stamp = to_stamp(message.reference_stamp);
  frame.motion = pose_from_fields(message.translation, message.rotation);
  if (!is_rigid(frame.motion)) return "sparse frame with a motion that is not rigid";
  Result<BlockMask> mask =
      decode_mask(message.mask, BlockGrid(frame.camera.width, frame.camera.height));
  if (!mask) return mask.reason();
  frame.mask = std::move(*mask);
  if (message.depth_mask.empty()) return {};
  Result<BlockMask> depth = decode_mask(message.depth_mask, frame.mask.grid());
  if (!depth) return "depth mask: " + depth.reason();
  frame.depth_mask = std::move(*depth);
  return {};
}

}  // namespace

Result<OutgoingImages> images_of(const rprr_msgs::OutgoingFrame& message, double unit_for_float) {
  OutgoingImages images;
  const Result<Camera> camera = camera_from_info(message.camera_info);
  if (!camera) return Error{camera.reason()};
  Result<DepthFrame> depth = depth_from_image(message.depth, unit_for_float);
  if (!depth) return Error{"depth: " + depth.reason()};
  Result<cv::Mat> bgr = bgr_from_image(message.rgb);
  if (!bgr) return Error{"rgb: " + bgr.reason()};
  images.depth = std::move(*depth);
  images.bgr = std::move(*bgr);
  images.frame.camera = *camera;
  images.frame.sparse = message.sparse != 0;
  images.frame.report = report_of(message);
  if (images.frame.sparse) {
    const std::string problem = add_reference(message, images.frame);
    if (!problem.empty()) return Error{problem};
  }
  return images;
}

}  // namespace rprr
