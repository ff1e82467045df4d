// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange_registration.hpp"

#include <utility>

namespace rprr {
namespace {

const std::string kA = "eyebug_a";
const std::string kB = "eyebug_b";

class SamplesRegistration final : public Registration {
 public:
  SamplesRegistration(std::string name, const SamplesOptions& options)
      : name_(std::move(name)), options_(options) {}

  std::string name() const override { return name_; }

  RegistrationResult align(const PoseFrame& a, const PoseFrame& b, const Pose& start) override {
    constexpr Stamp kStamp = from_seconds(1000.0);
    ExchangeHarness harness = make_samples_exchange(options_, 0);
    const ExchangeOutcome outcome =
        harness.run(as_frame_of(a, kA, kStamp), as_frame_of(b, kB, kStamp));
    RegistrationResult result;
    result.motion = start;
    result.bytes = outcome.bytes;
    if (!outcome.pose) return result;
    const PoseStatus status = outcome.pose->status;
    result.motion = outcome.pose->motion;
    result.accepted = status == PoseStatus::kAccepted;
    result.converged = status != PoseStatus::kTimedOut && status != PoseStatus::kTooFewPoints &&
                       status != PoseStatus::kNotConverged && status != PoseStatus::kMalformed;
    result.iterations = outcome.pose->iterations;
    result.residual = static_cast<double>(outcome.pose->residual);
    return result;
  }

 private:
  const std::string name_;
  const SamplesOptions options_;
};

}  // namespace

ExchangeHarness make_samples_exchange(const SamplesOptions& options, Duration one_way_latency) {
  SamplesOptions at_a = options;
  at_a.self = kA;
  at_a.peer = kB;
  SamplesOptions at_b = options;
  at_b.self = kB;
  at_b.peer = kA;
  return {make_samples_reference(at_a), make_samples_dependent(at_b), one_way_latency};
}

std::unique_ptr<Registration> make_samples_registration(const std::string& name,
                                                        const SamplesOptions& options) {
  return std::make_unique<SamplesRegistration>(name, options);
}

PoseFramePtr as_frame_of(const PoseFrame& frame, const std::string& robot, Stamp stamp) {
  auto copy = std::make_shared<PoseFrame>(frame);
  copy->stamp = stamp;
  copy->frame_id = robot + "_rgb_optical_frame";
  copy->camera = rounded_for_wire(frame.camera);
  return copy;
}

}  // namespace rprr
