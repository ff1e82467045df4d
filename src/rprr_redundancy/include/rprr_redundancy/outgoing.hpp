// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_geometry/steady_time.hpp"
#include "rprr_redundancy/recent_stamps.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Length of the rprr_msgs/BlockMask that carries data_length bytes, serialised by ROS.
constexpr std::size_t block_mask_message_bytes(std::size_t frame_id_length,
                                               std::size_t receiver_length,
                                               std::size_t data_length) {
  return ros_header_bytes(frame_id_length) + ros_array_bytes(receiver_length) + 4 +
         ros_array_bytes(data_length);
}

struct OutgoingOptions {
  Duration prediction_timeout = from_seconds(1.0);  // after the pose was accepted
  std::size_t waiting = 8;                          // frames that may wait for their prediction
  std::size_t early_predictions = 8;                // predictions that came before their event
  std::size_t largest_mask = std::size_t{1} << 17;  // a longer mask is malformed [bytes]
};

/// What b sends of one of its frames.
struct OutgoingDecision {
  Stamp stamp = 0;             // of b's frame
  std::uint32_t exchange = 0;  // 0: none
  bool sparse = false;
  std::string reason;             // whole: why
  BlockMask mask;                 // sparse: what a asks for (B_p, or with a preview more) u B_v
  BlockMask depth_mask;           // sparse: of these, blocks to send with depth
  int blocks_predicted = 0;       // sparse: blocks that a asks for
  int blocks_validated = 0;       // sparse: |B_v|
  std::size_t message_bytes = 0;  // of the prediction, serialised; also where it was of no use
};

/// A prediction as it came over the radio. Everything in it is untrusted.
struct PredictionMessage {
  std::string sender;  // by the topic that it came on
  std::string receiver;
  std::uint32_t exchange = 0;
  Stamp stamp = 0;  // of the frame of b that the blocks belong to
  ByteView mask;    // rprr_wire/mask_wire.hpp
  std::size_t frame_id_length = 0;
};

/// Robot b decides what goes out: a pure state machine without a clock of its own.
/// Every frame that an event names leads to exactly one decision, whatever is lost, repeated,
/// reordered or damaged on the way; memory is bounded. `now` is any steady time in nanoseconds.
class Outgoing {
 public:
  explicit Outgoing(std::string robot, OutgoingOptions options = {});

  /// The exchange says: send this frame whole.
  std::vector<OutgoingDecision> whole(Stamp stamp, std::uint32_t exchange, std::string reason);

  /// The exchange with `peer` found a pose; `validated` is B_v of the frame and lends its grid to
  /// the mask that is to come from the peer.
  std::vector<OutgoingDecision> accepted(Stamp stamp, const std::string& peer,
                                         std::uint32_t exchange, BlockMask validated,
                                         SteadyTime now);

  /// Ignored: predictions for others, repeated ones, ones for frames that are decided or that wait
  /// for another peer's.
  std::vector<OutgoingDecision> prediction(const PredictionMessage& message, SteadyTime now);

  /// Frames whose prediction did not come in time go out whole.
  std::vector<OutgoingDecision> tick(SteadyTime now);

  /// Somebody else decided about the frame: it neither waits nor is decided about any more.
  void settle(Stamp stamp);

  /// Time went back: stamps name other frames from now on. What waits is forgotten.
  void restart();

  /// Whether a frame waits for its prediction, and how many do.
  bool waits(Stamp stamp) const;
  std::size_t waiting() const { return waiting_.size(); }
  std::size_t early_predictions() const { return early_.size(); }

 private:
  struct Waiting {
    Stamp stamp;
    std::string peer;
    std::uint32_t exchange;
    BlockMask validated;
    SteadyTime deadline;
  };
  struct Early {
    Stamp stamp;
    std::string sender;
    std::uint32_t exchange;
    Bytes mask;
    bool too_long;
    std::size_t message_bytes;
    SteadyTime forget_at;
  };

  void drop_waiting(Stamp stamp);
  OutgoingDecision decide(const Waiting& frame, const Early& prediction);
  OutgoingDecision give_up(const Waiting& frame, std::string reason);

  std::string robot_;
  OutgoingOptions options_;
  std::deque<Waiting> waiting_;
  std::deque<Early> early_;
  RecentStamps decided_;
};

}  // namespace rprr
