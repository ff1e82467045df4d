// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/iterations/exchange_survey.hpp"

#include <algorithm>
#include <numeric>

#include "rprr_eval/exchange/exchange_registration.hpp"
#include "rprr_eval/measure/median.hpp"

namespace rprr {

void ExchangeSurveyor::add(const RgbdFrame& a, const RgbdFrame& b) {
  const Stamp stamp = from_seconds(1000.0 + ++number_);
  const ExchangeOutcome outcome =
      harness_.run(as_frame_of(a, "eyebug_a", stamp), as_frame_of(b, "eyebug_b", stamp));
  const double latency = 1e3 * to_seconds(outcome.elapsed);
  ++sums_.pairs;
  latency_.push_back(latency);
  compute_.push_back(1e3 * outcome.seconds_compute);
  if (!outcome.pose || !outcome.pose->verdict.accepted()) {
    ++sums_.rejected[outcome.pose ? cause_of(outcome.pose->verdict.status) : "no answer"];
    return;
  }
  ++sums_.accepted;
  ++sums_.histogram[outcome.pose->iterations];
  sums_.max_iterations = std::max(sums_.max_iterations, static_cast<int>(outcome.pose->iterations));
  iterations_ += outcome.pose->iterations;
  messages_ += outcome.messages;
  bytes_.push_back(static_cast<double>(outcome.bytes));
  accepted_latency_.push_back(latency);
}

ExchangeSurvey ExchangeSurveyor::survey() const {
  ExchangeSurvey survey = sums_;
  survey.median_latency_ms = median(latency_);
  survey.median_accepted_latency_ms = median(accepted_latency_);
  survey.median_compute_ms = median(compute_);
  survey.median_bytes = median(bytes_);
  if (survey.accepted == 0) return survey;
  const double bytes = std::accumulate(bytes_.begin(), bytes_.end(), 0.0);
  survey.mean_bytes = bytes / survey.accepted;
  survey.mean_messages = static_cast<double>(messages_) / survey.accepted;
  survey.mean_iterations = static_cast<double>(iterations_) / survey.accepted;
  if (iterations_ > 0) survey.bytes_per_iteration = bytes / static_cast<double>(iterations_);
  return survey;
}

Distances distances_of(const TumFolder& folder, const std::vector<int>& original_frames) {
  Distances distances;
  for (const int frames : original_frames) {
    const auto entries = static_cast<std::size_t>(frames / folder.frame_stride);
    if (frames % folder.frame_stride != 0) {
      distances.refused.emplace_back(frames, "the folder holds every " +
                                                 std::to_string(folder.frame_stride) +
                                                 "th original frame: not a multiple of that");
    } else if (folder.entries.size() <= entries) {
      distances.refused.emplace_back(
          frames, "the folder has only " + std::to_string(folder.entries.size()) + " entries");
    } else {
      distances.allowed.emplace_back(frames, entries);
    }
  }
  return distances;
}

}  // namespace rprr
