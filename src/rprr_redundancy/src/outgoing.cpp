// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/outgoing.hpp"

#include <algorithm>
#include <utility>

#include "rprr_wire/mask_wire.hpp"

namespace rprr {

Outgoing::Outgoing(std::string robot, OutgoingOptions options)
    : robot_(std::move(robot)), options_(options) {
}

std::vector<OutgoingDecision> Outgoing::whole(Stamp stamp, std::uint32_t exchange,
                                              std::string reason) {
  // An exchange that ends without a pose after all takes its frame out of the waiting line.
  drop_waiting(stamp);
  if (!decided_.insert(stamp)) return {};
  OutgoingDecision decision;
  decision.stamp = stamp;
  decision.exchange = exchange;
  decision.reason = std::move(reason);
  return {std::move(decision)};
}

std::vector<OutgoingDecision> Outgoing::accepted(Stamp stamp, const std::string& peer,
                                                 std::uint32_t exchange, BlockMask validated,
                                                 SteadyTime now) {
  if (decided_.contains(stamp) || waits(stamp)) return {};
  Waiting frame{stamp, peer, exchange, std::move(validated), now + options_.prediction_timeout};
  const auto early = std::find_if(early_.begin(), early_.end(), [&](const Early& prediction) {
    return prediction.stamp == stamp && prediction.exchange == exchange &&
           prediction.sender == peer;
  });
  if (early != early_.end()) {
    OutgoingDecision decision = decide(frame, *early);
    early_.erase(early);
    return {std::move(decision)};
  }
  std::vector<OutgoingDecision> decisions;
  if (waiting_.size() >= std::max<std::size_t>(options_.waiting, 1)) {
    decisions.push_back(give_up(waiting_.front(), "too many frames wait for a prediction"));
    waiting_.pop_front();
  }
  waiting_.push_back(std::move(frame));
  return decisions;
}

std::vector<OutgoingDecision> Outgoing::prediction(const PredictionMessage& message,
                                                   SteadyTime now) {
  if (message.receiver != robot_ || decided_.contains(message.stamp)) return {};
  const bool too_long = message.mask.size > options_.largest_mask;
  Early prediction{
      message.stamp,
      message.sender,
      message.exchange,
      {},
      too_long,
      block_mask_message_bytes(message.frame_id_length, message.receiver.size(), message.mask.size),
      now + 2 * options_.prediction_timeout};
  if (!too_long) {
    prediction.mask.assign(message.mask.data, message.mask.data + message.mask.size);
  }
  const auto frame = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
    return waiting.stamp == message.stamp && waiting.exchange == message.exchange &&
           waiting.peer == message.sender;
  });
  if (frame != waiting_.end()) {
    OutgoingDecision decision = decide(*frame, prediction);
    waiting_.erase(frame);
    return {std::move(decision)};
  }
  const bool repeated = std::any_of(early_.begin(), early_.end(), [&](const Early& early) {
    return early.stamp == message.stamp && early.exchange == message.exchange &&
           early.sender == message.sender;
  });
  if (repeated || options_.early_predictions == 0) return {};
  if (early_.size() >= options_.early_predictions) early_.pop_front();
  early_.push_back(std::move(prediction));
  return {};
}

std::vector<OutgoingDecision> Outgoing::tick(SteadyTime now) {
  std::vector<OutgoingDecision> decisions;
  while (!waiting_.empty() && waiting_.front().deadline <= now) {
    decisions.push_back(give_up(waiting_.front(), "the prediction did not come in time"));
    waiting_.pop_front();
  }
  while (!early_.empty() && early_.front().forget_at <= now) early_.pop_front();
  return decisions;
}

void Outgoing::settle(Stamp stamp) {
  drop_waiting(stamp);
  decided_.insert(stamp);
}

void Outgoing::drop_waiting(Stamp stamp) {
  const auto same = [stamp](const Waiting& frame) { return frame.stamp == stamp; };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), same), waiting_.end());
}

void Outgoing::restart() {
  waiting_.clear();
  early_.clear();
  decided_ = RecentStamps();
}

bool Outgoing::waits(Stamp stamp) const {
  return std::any_of(waiting_.begin(), waiting_.end(),
                     [stamp](const Waiting& frame) { return frame.stamp == stamp; });
}

OutgoingDecision Outgoing::decide(const Waiting& frame, const Early& prediction) {
  const Result<BlockMaskPair> predicted =
      prediction.too_long ? Result<BlockMaskPair>(Error{"block mask too long"})
                          : decode_mask_pair(prediction.mask, frame.validated.grid());
  OutgoingDecision decision;
  if (!predicted) {
    decision = give_up(frame, "unreadable prediction: " + predicted.reason());
    decision.message_bytes = prediction.message_bytes;
    return decision;
  }
  decided_.insert(frame.stamp);
  decision.stamp = frame.stamp;
  decision.exchange = frame.exchange;
  decision.sparse = true;
  decision.blocks_predicted = predicted->colour.count();
  decision.blocks_validated = frame.validated.count();
  decision.mask = predicted->colour;
  decision.mask |= frame.validated;
  decision.depth_mask = predicted->depth;
  decision.depth_mask |= frame.validated;
  decision.message_bytes = prediction.message_bytes;
  return decision;
}

OutgoingDecision Outgoing::give_up(const Waiting& frame, std::string reason) {
  decided_.insert(frame.stamp);
  OutgoingDecision decision;
  decision.stamp = frame.stamp;
  decision.exchange = frame.exchange;
  decision.reason = std::move(reason);
  return decision;
}

}  // namespace rprr
