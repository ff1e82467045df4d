// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rprr_pose/exchange.hpp"

namespace rprr {

/// What one exchange between two robots led to.
struct ExchangeOutcome {
  std::optional<RelativePoseMessage> pose;  // as the reference ended it; none if it never did
  std::vector<FrameDecision> at_reference;  // in their order
  FrameDecision at_dependent;               // what becomes of b's frame
  std::size_t bytes = 0;                    // serialised, both ways
  int messages = 0;                         // both ways
  double seconds_compute = 0.0;             // processor time of both roles
  Duration elapsed = 0;                     // on the simulated clock
};

/// A robot as the reference and one as the dependent, tied back to back on a simulated clock: the
/// state machines that the nodelets run, without ROS. Messages arrive one latency after they were
/// sent, in order.
class ExchangeHarness {
 public:
  struct Side {
    std::string name;  // of the robot, as the other side knows it
    std::unique_ptr<ExchangeRole> role;
  };
  ExchangeHarness(Side reference, Side dependent, Duration one_way_latency);

  /// Gives both robots a frame and lets time pass until b's frame is decided. The roles keep what
  /// they know between calls, as robots do.
  ExchangeOutcome run(const RgbdFramePtr& a, const RgbdFramePtr& b);

 private:
  struct InFlight {
    SteadyTime arrival;
    bool to_dependent;
    PoseMessage message;
  };

  void take(RoleOutput output, bool from_reference, ExchangeOutcome& outcome);
  template <typename Action>
  void act(bool at_reference, ExchangeOutcome& outcome, const Action& action);

  Side reference_;
  Side dependent_;
  const Duration latency_;
  SteadyTime now_;
  std::vector<InFlight> channel_;
  bool decided_ = false;
};

}  // namespace rprr
