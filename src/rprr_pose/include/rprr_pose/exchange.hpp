// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_pose/messages.hpp"
#include "rprr_pose/pose_frame.hpp"

namespace rprr {

/// What an exchange decided about one of the robot's own frames (rprr_msgs/ExchangeEvent).
struct FrameDecision {
  enum class Action : std::uint8_t { kSendWhole = 0, kSendSparse = 1 };
  Action action = Action::kSendWhole;
  PoseFramePtr frame;
  std::uint32_t exchange = 0;  // 0: none
  std::string peer;            // empty: none
  std::string reason;          // why whole, for people
  RelativePoseMessage pose;    // with kSendSparse
  /// This is the verdict that the dependent learnt from the reference. It is empty where none came,
  /// and at the reference itself.
  std::optional<PoseVerdict> verdict;
  std::optional<Camera> peer_camera;
  Bytes peer_preview;  // at the reference: b's preview as it came; empty if there is none
  std::uint32_t exchange_bytes = 0;  // pose messages of the exchange, both ways, serialised
};

/// What a role wants done after it was given something.
struct RoleOutput {
  std::vector<PoseMessage> send;
  std::vector<FrameDecision> decisions;
  std::vector<std::string> problems;  // hostile or unexpected input, for diagnostics
};

/// What a role needs to know of its robot's radio.
struct RadioState {
  bool ready = true;  // a frame more can be sent
  std::vector<Stamp>
      references;              // own whole frames that the station holds or was sent, newest last
  double frame_seconds = 0.0;  // that a whole frame takes to the station; 0: not known
};

/// One robot's side of the exchanges with one peer: a pure state machine. Frames, messages and the
/// time (any monotonic clock, nanoseconds) go in; messages and decisions come out. Nodelets,
/// rprr_eval and tests drive the same objects. One thread at a time.
class ExchangeRole {
 public:
  virtual ~ExchangeRole() = default;
  /// A new frame of this robot.
  virtual void offer(const PoseFramePtr& frame, Stamp now, RoleOutput& out) = 0;
  /// A message of the peer, as it came from the radio. Those for other receivers are ignored.
  virtual void receive(const PoseMessage& message, Stamp now, RoleOutput& out) = 0;
  /// Time passes; call it a few times per timeout.
  virtual void tick(Stamp now, RoleOutput& out) = 0;
  /// The radio has room, or has not. Roles that do not pace themselves ignore it.
  virtual void set_radio(const RadioState& /*radio*/, Stamp /*now*/, RoleOutput& /*out*/) {}
};

}  // namespace rprr
