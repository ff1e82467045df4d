// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_pose/pose_verdict.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// The messages of an exchange as the roles see them: what rprr_msgs carries, without ROS. `data`
/// is untrusted until the parsers of samples_wire.hpp and update_wire.hpp accepted it.
struct SamplesMessage {
  Stamp stamp = 0;       // of the sender's frame
  std::string frame_id;  // optical frame of the sender
  std::string receiver;
  std::uint32_t exchange = 0;
  Bytes data;
};

struct UpdateMessage {
  Stamp stamp = 0;
  std::string receiver;
  std::uint32_t exchange = 0;
  Bytes data;
};

struct RelativePoseMessage {
  Stamp stamp = 0;       // of the reference's frame
  std::string frame_id;  // optical frame of the reference
  Stamp dependent_stamp = 0;
  std::string dependent;  // the receiver
  std::uint32_t exchange = 0;
  PoseVerdict verdict;                   // b_from_a means something only if it is accepted
  Pose b_from_a = Pose::Identity();      // the paper's M_ab: p_b = b_from_a p_a
  Matrix6 covariance = Matrix6::Zero();  // of the left perturbation (tx ty tz rx ry rz)
  std::uint16_t iterations = 0;
  std::uint16_t inliers = 0;
  float residual = 0.0f;       // RMS, metres
  double dependent_age = 0.0;  // seconds by the reference's clock (rprr_msgs/RelativePose), as the
  float reply_delay = 0.0f;    // next: whoever puts it on the radio fills them in
  Bytes reference_camera;      // empty if the dependent knows it
  std::uint32_t bytes_spent = 0;
};

struct PreviewMessage {
  Stamp stamp = 0;       // of the sender's frame
  std::string frame_id;  // optical frame of the sender
  std::string receiver;
  std::uint32_t exchange = 0;
  Bytes data;
};

using PoseMessage =
    std::variant<SamplesMessage, UpdateMessage, RelativePoseMessage, PreviewMessage>;

/// Length of the message as ROS serialises it: what it costs on the radio, for each receiver.
std::size_t serialised_bytes(const SamplesMessage& message);
std::size_t serialised_bytes(const UpdateMessage& message);
std::size_t serialised_bytes(const RelativePoseMessage& message);
std::size_t serialised_bytes(const PreviewMessage& message);
std::size_t serialised_bytes(const PoseMessage& message);

/// Whom a message is for.
const std::string& receiver_of(const PoseMessage& message);

}  // namespace rprr
