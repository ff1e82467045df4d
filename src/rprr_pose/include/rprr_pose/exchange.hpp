// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/rgbd_frame.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_geometry/steady_time.hpp"
#include "rprr_pose/messages.hpp"
#include "rprr_radio/link_state.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {

/// A dependent's preview as the director used it: decoded once, for all who look at it later.
struct ReceivedPreview {
  Bytes bytes;  ///< as they came (rprr_wire/preview.hpp)
  BlockPreview preview;
};

/// What an exchange decided about one of the robot's own frames (rprr_msgs/ExchangeEvent).
struct FrameDecision {
  enum class Action : std::uint8_t {
    kSendWhole = 0,      ///< no pose was found, or no peer spoke
    kSendSparse = 1,     ///< a pose to the peer's frame was accepted: send what that does not show
    kPredict = 2,        ///< the peer refers to this frame: tell it which blocks to send
    kSendReference = 3,  ///< the peer may refer to this frame: send it whole
  };
  Action action = Action::kSendWhole;
  RgbdFramePtr frame;
  /// How often stamps had gone back before the frame came (a recording that starts again, a clock
  /// that was set). Epoch and stamp together name a frame.
  std::uint32_t epoch = 0;
  std::uint32_t exchange = 0;  ///< 0: none
  std::string peer;            ///< empty: none
  std::string reason;          ///< kSendWhole: why, for people
  RelativePoseMessage pose;    ///< kSendSparse, kPredict
  /// What the dependent learnt from the reference. Empty where nothing came, and at the reference.
  std::optional<PoseVerdict> verdict;
  std::optional<Camera> peer_camera;                    ///< kSendSparse, kPredict
  std::shared_ptr<const ReceivedPreview> peer_preview;  ///< kPredict; null if there is none
  std::uint32_t exchange_bytes = 0;  ///< pose messages of the exchange, both ways, serialised
  float ms_pose = 0.0f;              ///< processor time of the exchange on this robot [ms]
};

/// A message of a peer that could not be used.
struct MessageProblem {
  std::string peer;
  std::string text;  ///< what was wrong, for people
};

/// What a role wants done after it was given something.
struct RoleOutput {
  std::vector<PoseMessage> send;
  std::vector<FrameDecision> decisions;
  std::vector<MessageProblem> problems;  ///< hostile or unexpected input, for diagnostics
};

/// One robot's side of its exchanges, as reference or as dependent: a pure state machine. Frames,
/// messages and the time (any monotonic clock, nanoseconds) go in; messages and decisions come out.
/// Nodelets, rprr_eval and tests drive the same objects. One thread at a time.
class ExchangeRole {
 public:
  virtual ~ExchangeRole() = default;
  /// A new frame of this robot.
  virtual void offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) = 0;
  /// A message of a peer, as it came from the radio. Those for other receivers and those of peers
  /// that the role does not serve are ignored.
  virtual void receive(const std::string& peer, const PoseMessage& message, SteadyTime now,
                       RoleOutput& out) = 0;
  /// Time passes; call it a few times per timeout.
  virtual void tick(SteadyTime now, RoleOutput& out) = 0;
  /// The radio has room, or has not. Roles that do not pace themselves ignore it.
  virtual void set_link_state(const LinkState& /*link*/, SteadyTime /*now*/, RoleOutput& /*out*/) {}
  /// An inactive role begins nothing of its own accord. It still answers, and what is under way
  /// ends as it would. Roles are active at first.
  virtual void set_active(bool /*active*/) {}
};

}  // namespace rprr
