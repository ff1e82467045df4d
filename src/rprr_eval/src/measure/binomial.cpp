// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/binomial.hpp"

#include <cmath>

namespace rprr {
namespace {

// P(at most `events` of `trials`) at the rate, 0 < rate < 1.
double at_most(int events, int trials, double rate) {
  double sum = 0.0;
  for (int i = 0; i <= events; ++i) {
    const double ways =
        std::lgamma(trials + 1.0) - std::lgamma(i + 1.0) - std::lgamma(trials - i + 1.0);
    sum += std::exp(ways + i * std::log(rate) + (trials - i) * std::log1p(-rate));
  }
  return sum;
}

}  // namespace

double clopper_pearson_upper(int events, int trials, double confidence) {
  if (trials <= 0 || events >= trials) return 1.0;
  double low = static_cast<double>(events) / trials;
  double high = 1.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (at_most(events, trials, middle) > 1.0 - confidence ? low : high) = middle;
  }
  return high;
}

}  // namespace rprr
