// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rprr_codec/outgoing_frame.hpp"
#include "rprr_pose/exchange.hpp"
#include "rprr_redundancy/decision.hpp"
#include "rprr_redundancy/outgoing.hpp"
#include "rprr_redundancy/recent_stamps.hpp"
#include "rprr_redundancy/redundancy_options.hpp"
#include "rprr_redundancy/validation.hpp"

namespace rprr {

/// What this robot, as the reference, tells a dependent to send (rprr_msgs/BlockMask).
struct BlockRequest {
  std::string receiver;
  std::uint32_t exchange = 0;
  Stamp stamp = 0;         ///< of the dependent's frame
  BlockDecision decision;  ///< what crosses the radio is decision.send
  float ms = 0.0f;         ///< that it took [ms]
  // For people who look at it:
  Camera camera;                                   ///< the dependent's
  std::shared_ptr<const ReceivedPreview> preview;  ///< null: none
};

/// B_v of one of this robot's frames.
struct ValidatedBlocks {
  RgbdFramePtr frame;
  std::uint32_t exchange = 0;
  BlockMask blocks;
};

/// What the stage wants done after it was given something.
struct RedundancyOutput {
  std::vector<BlockRequest> requests;        ///< for the radio
  std::vector<OutgoingFrame> frames;         ///< for the encoder
  std::vector<ValidatedBlocks> validations;  ///< for people
  std::vector<std::string> problems;         ///< decisions that make no sense, for diagnostics
};

/// The redundancy stage of one robot: which blocks of its own frames go out, and which blocks of
/// their frames its peers are told to send. For any number of peers, as reference and as dependent.
///
/// Every frame that is to go out goes out: whole or sparse once, and once more whole if a peer
/// refers to a frame that had gone out sparsely. `now` is any steady time in nanoseconds. Memory is
/// bounded (OutgoingOptions). One thread at a time.
class Redundancy {
 public:
  explicit Redundancy(std::string robot, const RedundancyOptions& options = {});

  /// What an exchange decided about one of this robot's frames. Decisions are local but may come
  /// from another process: what makes no sense is a problem, and the frame goes out whole.
  void take(const FrameDecision& decision, SteadyTime now, RedundancyOutput& out);
  /// A prediction as it came over the radio: untrusted.
  void receive(const PredictionMessage& message, SteadyTime now, RedundancyOutput& out);
  /// Frames whose prediction did not come in time go out whole. Call it a few times per timeout.
  void tick(SteadyTime now, RedundancyOutput& out);

 private:
  struct Held {
    FrameDecision decision;
    float ms_validate = 0.0f;
  };

  void predict(const FrameDecision& decision, RedundancyOutput& out);
  void send_reference(const FrameDecision& decision, RedundancyOutput& out);
  void decide(const FrameDecision& decision, SteadyTime now, RedundancyOutput& out);
  void emit(const std::vector<OutgoingDecision>& decisions, RedundancyOutput& out);
  OutgoingFrame frame_of(const OutgoingDecision& decision, const Held& held);

  const std::string robot_;
  Decider decider_;
  Validator validator_;
  Outgoing outgoing_;
  std::map<Stamp, Held> held_;  // frames that wait for a prediction, as outgoing_ bounds them
  RecentStamps whole_;          // frames that went out whole
  std::uint32_t epoch_ = 0;     // of the frames that are remembered
  float ms_predict_ = 0.0f;     // of predictions that no frame reported yet [ms]
};

}  // namespace rprr
