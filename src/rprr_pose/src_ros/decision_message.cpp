// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose_ros/decision_message.hpp"

#include <utility>

#include "rprr_pose_ros/message_conversions.hpp"
#include "rprr_ros/frame_message.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

using Action = FrameDecision::Action;

// Empty, or what makes no sense.
std::string read(const rprr_msgs::ExchangeEvent& message, FrameDecision& decision) {
  if (message.action > static_cast<std::uint8_t>(Action::kSendReference)) return "unknown action";
  decision.action = static_cast<Action>(message.action);
  if (!message.peer_camera.empty()) {
    ByteReader reader{ByteView(message.peer_camera)};
    const Result<Camera> camera = get_camera(reader);
    if (!camera) return "the peer's camera: " + camera.reason();
    decision.peer_camera = *camera;
  }
  if (!message.peer_preview.empty()) {
    Result<BlockPreview> preview = decode_preview(message.peer_preview);
    if (!preview) return "the peer's preview: " + preview.reason();
    decision.peer_preview = std::make_shared<ReceivedPreview>(
        ReceivedPreview{message.peer_preview, std::move(*preview)});
  }
  const Result<RgbdFramePtr> frame = frame_from_message(message.frame);
  if (!frame) return frame.reason();
  decision.frame = *frame;
  return {};
}

}  // namespace

rprr_msgs::ExchangeEvent to_message(const FrameDecision& decision) {
  rprr_msgs::ExchangeEvent message;
  if (decision.frame) message.frame = to_message(*decision.frame);
  message.epoch = decision.epoch;
  message.action = static_cast<std::uint8_t>(decision.action);
  message.exchange = decision.exchange;
  message.peer = decision.peer;
  message.reason = decision.reason;
  message.pose = to_ros(decision.pose);
  if (decision.peer_camera) {
    ByteWriter writer;
    put_camera(writer, *decision.peer_camera);
    message.peer_camera = writer.take();
  }
  if (decision.peer_preview) message.peer_preview = decision.peer_preview->bytes;
  message.ms_pose = decision.ms_pose;
  message.exchange_bytes = decision.exchange_bytes;
  return message;
}

void from_message(const rprr_msgs::ExchangeEvent& message, FrameDecision& decision) {
  decision = FrameDecision();
  decision.epoch = message.epoch;
  decision.exchange = message.exchange;
  decision.peer = message.peer;
  decision.reason = message.reason;
  decision.pose = from_ros(message.pose);
  decision.ms_pose = message.ms_pose;
  decision.exchange_bytes = message.exchange_bytes;
  const std::string wrong = read(message, decision);
  if (!wrong.empty()) decision.reason = wrong;
}

}  // namespace rprr
