// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/exchange/exchange_registration.hpp"

#include <utility>

#include "rprr_pose/exchange_stage.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

const std::string kA = "eyebug_a";
const std::string kB = "eyebug_b";

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

  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    if (profile_.use_previews && (a.bgr.empty() || b.bgr.empty())) {
      RegistrationResult without_colour;  // a preview cannot do without
      without_colour.b_from_a = start;
      return without_colour;
    }
    constexpr Stamp kStamp = from_seconds(1000.0);
    ExchangeHarness harness = make_exchange(profile_, 0);
    const ExchangeOutcome outcome =
        harness.run(as_frame_of(a, kA, kStamp), as_frame_of(b, kB, kStamp));
    RegistrationResult result;
    result.b_from_a = start;
    result.bytes = outcome.bytes;
    if (!outcome.pose) return result;
    const PoseVerdict& verdict = outcome.pose->verdict;
    result.b_from_a = outcome.pose->b_from_a;
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
  return make_exchange(profile, kA, kB, one_way_latency);
}

ExchangeHarness make_exchange(const Profile& profile, const std::string& a, const std::string& b,
                              Duration one_way_latency) {
  auto reference = std::make_unique<ExchangeStage>(a, profile, std::vector<std::string>{b});
  auto dependent = std::make_unique<ExchangeStage>(b, profile, std::vector<std::string>{a});
  dependent->set_reference(a, true);
  return {{a, std::move(reference)}, {b, std::move(dependent)}, one_way_latency};
}

std::unique_ptr<Registration> make_exchange_registration(const std::string& name,
                                                         const Profile& profile) {
  return std::make_unique<ExchangeRegistration>(name, profile);
}

RgbdFramePtr as_frame_of(const RgbdFrame& frame, const std::string& robot, Stamp stamp) {
  auto copy = std::make_shared<RgbdFrame>(frame);
  copy->stamp = stamp;
  copy->frame_id = robot + "_rgb_optical_frame";
  copy->camera = rounded_for_wire(frame.camera);
  return copy;
}

}  // namespace rprr
