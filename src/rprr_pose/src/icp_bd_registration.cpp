// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "rprr_pose/icp_bd.hpp"
#include "rprr_pose/registration.hpp"

namespace rprr {
namespace {

SampledSurface surface_of(const RgbdFrame& frame, int iteration, std::uint32_t side) {
  const auto seed = 2 * static_cast<std::uint32_t>(iteration) + side;
  return {frame.camera, frame.depth.unit,
          sample_points(frame.depth, frame.camera, kSampleCount, seed)};
}

// The two halves of icp_bd.hpp back to back: what two robots compute, without the radio.
class IcpBd final : public Registration {
 public:
  explicit IcpBd(const IterationLimits& limits) : limits_(limits) {}

  std::string name() const override { return "icp_bd"; }

  RegistrationResult align(const RgbdFrame& a, const RgbdFrame& b, const Pose& start) override {
    RegistrationResult result;
    result.b_from_a = start;
    IcpWeights weights{0.0, false};
    while (result.iterations < limits_.max_iterations && !result.converged) {
      NormalEquations sums = half_at_dependent(surface_of(a, result.iterations, 0), b.depth,
                                               b.camera, result.b_from_a, weights);
      sums += half_at_reference(surface_of(b, result.iterations, 1), a.depth, a.camera,
                                result.b_from_a, weights);
      Twist step;
      if (!solve(sums, step)) return result;
      ++result.iterations;
      result.residual = std::sqrt(sums.sum_residual2 / sums.sum_weight);
      result.b_from_a = exp_se3(step) * result.b_from_a;
      weights.c = sums.sum_abs_dz / sums.matched;
      result.converged = limits_.reached_by(step);
    }
    result.accepted = result.converged;
    return result;
  }

 private:
  const IterationLimits limits_;
};

}  // namespace

std::unique_ptr<Registration> make_icp_bd(const IterationLimits& limits) {
  return std::make_unique<IcpBd>(limits);
}

}  // namespace rprr
