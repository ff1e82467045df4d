// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange_registration.hpp"

#include <utility>

namespace rprr {
namespace {

const std::string kA = "eyebug_a";
const std::string kB = "eyebug_b";

template <typename Options>
Options between(Options options, const std::string& self, const std::string& peer) {
  options.self = self;
  options.peer = peer;
  return options;
}

// Where matched points were too few, or a test of the pose failed, the iteration came to its end.
bool has_converged(const PoseVerdict& verdict) {
  return verdict.status != PoseStatus::kTimedOut && verdict.status != PoseStatus::kNotConverged &&
         verdict.status != PoseStatus::kMalformed && verdict.quantity != PoseQuantity::kValidPoints;
}

class ExchangeRegistration final : public Registration {
 public:
  ExchangeRegistration(std::string name, const Profile& profile)
      : name_(std::move(name)), profile_(profile) {}

  std::string name() const override { return name_; }

  RegistrationResult align(const PoseFrame& a, const PoseFrame& b, const Pose& start) override {
    if (profile_.use_previews && (a.bgr.empty() || b.bgr.empty())) {
      RegistrationResult without_colour;  // a preview cannot do without
      without_colour.motion = start;
      return without_colour;
    }
    constexpr Stamp kStamp = from_seconds(1000.0);
    ExchangeHarness harness = make_exchange(profile_, 0);
    const ExchangeOutcome outcome =
        harness.run(as_frame_of(a, kA, kStamp), as_frame_of(b, kB, kStamp));
    RegistrationResult result;
    result.motion = start;
    result.bytes = outcome.bytes;
    if (!outcome.pose) return result;
    const PoseVerdict& verdict = outcome.pose->verdict;
    result.motion = outcome.pose->motion;
    result.accepted = verdict.accepted();
    result.converged = has_converged(verdict);
    result.iterations = outcome.pose->iterations;
    result.residual = static_cast<double>(outcome.pose->residual);
    return result;
  }

 private:
  const std::string name_;
  const Profile profile_;
};

}  // namespace

ExchangeHarness make_exchange(const Profile& profile, Duration one_way_latency) {
  if (profile.use_previews) {
    return {make_preview_reference(between(profile.preview, kA, kB)),
            make_preview_dependent(between(profile.preview, kB, kA)), one_way_latency};
  }
  return {make_samples_reference(between(profile.samples, kA, kB)),
          make_samples_dependent(between(profile.samples, kB, kA)), one_way_latency};
}

std::unique_ptr<Registration> make_exchange_registration(const std::string& name,
                                                         const Profile& profile) {
  return std::make_unique<ExchangeRegistration>(name, profile);
}

PoseFramePtr as_frame_of(const PoseFrame& frame, const std::string& robot, Stamp stamp) {
  auto copy = std::make_shared<PoseFrame>(frame);
  copy->stamp = stamp;
  copy->frame_id = robot + "_rgb_optical_frame";
  copy->camera = rounded_for_wire(frame.camera);
  return copy;
}

}  // namespace rprr
