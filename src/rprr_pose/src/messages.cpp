// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/messages.hpp"

namespace rprr {

std::size_t serialised_bytes(const SamplesMessage& message) {
  return ros_header_bytes(message.frame_id.size()) + ros_array_bytes(message.receiver.size()) + 4 +
         ros_array_bytes(message.data.size());
}

std::size_t serialised_bytes(const UpdateMessage& message) {
  return ros_header_bytes(0) + ros_array_bytes(message.receiver.size()) + 4 +
         ros_array_bytes(message.data.size());
}

std::size_t serialised_bytes(const RelativePoseMessage& message) {
  constexpr std::size_t kVerdict = 1 + 1 + 4 + 4;
  constexpr std::size_t kNumbers =
      8 + 4 + kVerdict + 3 * 8 + 4 * 8 + 21 * 4 + 2 + 2 + 4 + 8 + 4 + 4 + 4;
  return ros_header_bytes(message.frame_id.size()) + ros_array_bytes(message.dependent.size()) +
         ros_array_bytes(message.reference_camera.size()) + kNumbers;
}

std::size_t serialised_bytes(const PreviewMessage& message) {
  return ros_header_bytes(message.frame_id.size()) + ros_array_bytes(message.receiver.size()) + 4 +
         ros_array_bytes(message.data.size());
}

std::size_t serialised_bytes(const PoseMessage& message) {
  return std::visit([](const auto& any) { return serialised_bytes(any); }, message);
}

const std::string& receiver_of(const PoseMessage& message) {
  if (const auto* samples = std::get_if<SamplesMessage>(&message)) return samples->receiver;
  if (const auto* update = std::get_if<UpdateMessage>(&message)) return update->receiver;
  if (const auto* preview = std::get_if<PreviewMessage>(&message)) return preview->receiver;
  return std::get<RelativePoseMessage>(message).dependent;
}

}  // namespace rprr
