// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/redundancy.hpp"

#include <utility>

#include "rprr_geometry/stopwatch.hpp"

namespace rprr {
namespace {

using Action = FrameDecision::Action;

// Empty, or why a pose cannot be used.
std::string problem_of(const FrameDecision& decision) {
  const std::string exchange = "the exchange with '" + decision.peer + "' ";
  if (!decision.pose.verdict.accepted()) {
    return exchange + "ended without an accepted pose";
  }
  if (!decision.peer_camera || !decision.peer_camera->valid()) return exchange + "gives no camera";
  if (!is_rigid(decision.pose.b_from_a)) return exchange + "gives a pose that is no rigid motion";
  return {};
}

}  // namespace

Redundancy::Redundancy(std::string robot, const RedundancyOptions& options)
    : robot_(std::move(robot)),
      decider_(options.decision),
      validator_(options.validation),
      outgoing_(robot_, options.outgoing) {
}

void Redundancy::take(const FrameDecision& decision, SteadyTime now, RedundancyOutput& out) {
  if (!decision.frame) {
    out.problems.push_back("a decision without a frame: " + decision.reason);
    return;
  }
  if (decision.epoch != epoch_) {  // stamps name other frames from now on
    epoch_ = decision.epoch;
    outgoing_.restart();
    held_.clear();
    whole_ = RecentStamps();
  }
  switch (decision.action) {
    case Action::kPredict:
      return predict(decision, out);
    case Action::kSendReference:
      return send_reference(decision, out);
    case Action::kSendWhole:
    case Action::kSendSparse:
      return decide(decision, now, out);
  }
}

void Redundancy::receive(const PredictionMessage& message, SteadyTime now, RedundancyOutput& out) {
  emit(outgoing_.prediction(message, now), out);
}

void Redundancy::tick(SteadyTime now, RedundancyOutput& out) {
  emit(outgoing_.tick(now), out);
}

// This robot is the reference: what can the peer's frame not be derived from?
void Redundancy::predict(const FrameDecision& decision, RedundancyOutput& out) {
  const std::string problem = problem_of(decision);
  if (!problem.empty()) {
    out.problems.push_back(problem + "; the peer's frame will come whole");
    return;
  }
  const Stopwatch watch;
  const RgbdFrame& frame = *decision.frame;
  BlockRequest request;
  request.receiver = decision.peer;
  request.exchange = decision.exchange;
  request.stamp = decision.pose.dependent_stamp;
  request.camera = *decision.peer_camera;
  request.preview = decision.peer_preview;
  request.decision =
      decider_.decide(frame.depth, frame.bgr, frame.camera, request.camera, decision.pose.b_from_a,
                      request.preview ? &request.preview->preview : nullptr);
  request.ms = watch.milliseconds();
  ms_predict_ += request.ms;
  out.requests.push_back(std::move(request));
}

// A mask is worth nothing where the station has not the reference. Also a frame that has gone out
// sparsely, or waits for its own prediction, goes out whole now.
void Redundancy::send_reference(const FrameDecision& decision, RedundancyOutput& out) {
  if (!whole_.insert(decision.frame->stamp)) return;
  OutgoingDecision whole;
  whole.stamp = decision.frame->stamp;
  whole.exchange = decision.exchange;
  whole.reason = decision.reason;
  outgoing_.settle(whole.stamp);
  held_.erase(whole.stamp);
  out.frames.push_back(frame_of(whole, {decision, 0.0f}));
}

// This robot is the dependent: B_v is computed while the reference still computes what it asks for.
void Redundancy::decide(const FrameDecision& decision, SteadyTime now, RedundancyOutput& out) {
  const RgbdFrame& frame = *decision.frame;
  if (whole_.contains(frame.stamp)) return;
  Held held{decision, 0.0f};
  BlockMask validated;
  std::string reason = decision.reason;
  if (decision.action == Action::kSendSparse) {
    reason = problem_of(decision);
    if (reason.empty()) {
      const Stopwatch watch;
      validated = validator_.validate(frame.depth, frame.camera, *decision.peer_camera,
                                      decision.pose.b_from_a);
      held.ms_validate = watch.milliseconds();
      out.validations.push_back({decision.frame, decision.exchange, validated});
    } else {
      out.problems.push_back(reason + "; the frame goes out whole");
    }
  }
  if (!outgoing_.waits(frame.stamp)) held_[frame.stamp] = held;
  emit(validated.empty() ? outgoing_.whole(frame.stamp, decision.exchange, reason)
                         : outgoing_.accepted(frame.stamp, decision.peer, decision.exchange,
                                              std::move(validated), now),
       out);
  if (!outgoing_.waits(frame.stamp)) held_.erase(frame.stamp);
}

void Redundancy::emit(const std::vector<OutgoingDecision>& decisions, RedundancyOutput& out) {
  for (const OutgoingDecision& decision : decisions) {
    const auto held = held_.find(decision.stamp);
    if (held == held_.end()) continue;
    if (!decision.sparse) whole_.insert(decision.stamp);
    out.frames.push_back(frame_of(decision, held->second));
    held_.erase(held);
  }
}

OutgoingFrame Redundancy::frame_of(const OutgoingDecision& decision, const Held& held) {
  OutgoingFrame outgoing;
  outgoing.frame = held.decision.frame;
  outgoing.exchange = decision.exchange;
  outgoing.sparse = decision.sparse;
  outgoing.reason = decision.reason;
  FrameReport& report = outgoing.report;
  report.ms_pose = held.decision.ms_pose;
  report.ms_predict = std::exchange(ms_predict_, 0.0f);
  report.ms_validate = held.ms_validate;
  // What an exchange cost is told once, with the dependent's frame.
  if (held.decision.action != Action::kSendReference) {
    report.bytes_pose = held.decision.exchange_bytes;
    report.bytes_masks = static_cast<std::uint32_t>(decision.message_bytes);
  }
  if (!decision.sparse) return outgoing;
  report.blocks_predicted = static_cast<std::uint16_t>(decision.blocks_predicted);
  report.blocks_validated = static_cast<std::uint16_t>(decision.blocks_validated);
  outgoing.reference = held.decision.peer;
  outgoing.reference_stamp = held.decision.pose.stamp;
  outgoing.b_from_a = held.decision.pose.b_from_a;
  outgoing.mask = decision.mask;
  outgoing.depth_mask = decision.depth_mask;
  return outgoing;
}

}  // namespace rprr
