// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange/exchange_harness.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace rprr {
namespace {

constexpr Duration kTick = from_seconds(0.01);
constexpr Duration kPatience = from_seconds(60.0);

}  // namespace

ExchangeHarness::ExchangeHarness(Side reference, Side dependent, Duration one_way_latency)
    : reference_(std::move(reference)),
      dependent_(std::move(dependent)),
      latency_(one_way_latency) {
}

template <typename Action>
void ExchangeHarness::act(bool at_reference, ExchangeOutcome& outcome, const Action& action) {
  RoleOutput output;
  const auto start = std::chrono::steady_clock::now();
  action(at_reference ? *reference_.role : *dependent_.role, output);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  outcome.seconds_compute += spent.count();
  take(std::move(output), at_reference, outcome);
}

void ExchangeHarness::take(RoleOutput output, bool from_reference, ExchangeOutcome& outcome) {
  for (PoseMessage& message : output.send) {
    outcome.bytes += serialised_bytes(message);
    ++outcome.messages;
    if (const auto* pose = std::get_if<RelativePoseMessage>(&message)) outcome.pose = *pose;
    channel_.push_back({now_ + latency_, from_reference, std::move(message)});
  }
  for (FrameDecision& decision : output.decisions) {
    if (!from_reference) {
      outcome.at_dependent = std::move(decision);
      decided_ = true;
    } else {
      outcome.at_reference.push_back(std::move(decision));
    }
  }
}

ExchangeOutcome ExchangeHarness::run(const RgbdFramePtr& a, const RgbdFramePtr& b) {
  ExchangeOutcome outcome;
  channel_.clear();
  decided_ = false;
  const SteadyTime start = now_;
  act(false, outcome, [&](ExchangeRole& role, RoleOutput& out) { role.offer(b, now_, out); });
  act(true, outcome, [&](ExchangeRole& role, RoleOutput& out) { role.offer(a, now_, out); });
  while (!decided_ && now_ - start < kPatience) {
    now_ = std::min(now_ + kTick, channel_.empty() ? now_ + kTick : channel_.front().arrival);
    while (!channel_.empty() && channel_.front().arrival <= now_) {
      const InFlight flight = std::move(channel_.front());
      channel_.erase(channel_.begin());
      const std::string& sender = flight.to_dependent ? reference_.name : dependent_.name;
      act(!flight.to_dependent, outcome, [&](ExchangeRole& role, RoleOutput& out) {
        role.receive(sender, flight.message, now_, out);
      });
    }
    for (const bool at_reference : {true, false}) {
      act(at_reference, outcome,
          [&](ExchangeRole& role, RoleOutput& out) { role.tick(now_, out); });
    }
  }
  outcome.elapsed = now_ - start;
  return outcome;
}

}  // namespace rprr
