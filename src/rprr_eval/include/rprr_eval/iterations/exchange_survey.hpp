// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "rprr_eval/exchange/exchange_harness.hpp"
#include "rprr_eval/measure/frame_source.hpp"

namespace rprr {

/// What exchanges over many pairs cost. Iterations, bytes and messages are of accepted exchanges,
/// as the paper counts "trials that converged successfully"; latency is of all.
struct ExchangeSurvey {
  int pairs = 0;
  int accepted = 0;
  std::map<std::string, int> rejected;  // by cause
  std::map<int, int> histogram;         // iterations -> exchanges
  double mean_iterations = 0.0;
  int max_iterations = 0;
  double mean_bytes = 0.0, median_bytes = 0.0;
  double mean_messages = 0.0;
  double bytes_per_iteration = 0.0;       // all bytes over all iterations
  double median_latency_ms = 0.0;         // frame to b's decision, simulated channel alone
  double median_compute_ms = 0.0;         // both robots, this machine
  double median_accepted_latency_ms = 0;  // of accepted exchanges
};

/// One pair after the other through one harness: the robots keep what they know of each other.
class ExchangeSurveyor {
 public:
  explicit ExchangeSurveyor(ExchangeHarness harness) : harness_(std::move(harness)) {}
  void add(const RgbdFrame& a, const RgbdFrame& b);
  ExchangeSurvey survey() const;

 private:
  ExchangeHarness harness_;
  ExchangeSurvey sums_;
  std::vector<double> bytes_, latency_, accepted_latency_, compute_;
  long iterations_ = 0, messages_ = 0;
  int number_ = 0;
};

/// Entries apart for frames apart, where the folder's frame_stride allows it: distances that are a
/// multiple of it and leave at least one pair.
struct Distances {
  std::vector<std::pair<int, std::size_t>> allowed;  // original frames, entries
  std::vector<std::pair<int, std::string>> refused;  // original frames, why
};
Distances distances_of(const TumFolder& folder, const std::vector<int>& original_frames);

}  // namespace rprr
