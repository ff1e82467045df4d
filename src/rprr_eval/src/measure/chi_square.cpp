// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/measure/chi_square.hpp"

#include <cmath>
#include <limits>

namespace rprr {
namespace {

constexpr double kEnough = 1e-15;
constexpr int kMostTerms = 100000;

// Regularised incomplete gamma functions (Abramowitz and Stegun 6.5): each converges fast on its
// own side of x = a + 1.
double lower_gamma_by_series(double a, double x) {
  double term = 1.0 / a;
  double sum = term;
  for (int n = 1; n < kMostTerms && term > kEnough * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

double upper_gamma_by_fraction(double a, double x) {
  // Lentz's way of evaluating a continued fraction.
  constexpr double kTiny = std::numeric_limits<double>::min() / kEnough;
  const auto not_zero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / not_zero(b);
  double fraction = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / not_zero(numerator * d + b);
    c = not_zero(b + numerator / c);
    fraction *= d * c;
    if (std::abs(d * c - 1.0) < kEnough) break;
  }
  return fraction * std::exp(a * std::log(x) - x - std::lgamma(a));
}

}  // namespace

double chi_square_probability(double value, double freedom) {
  if (value <= 0.0) return 0.0;
  const double a = 0.5 * freedom;
  const double x = 0.5 * value;
  return x < a + 1.0 ? lower_gamma_by_series(a, x) : 1.0 - upper_gamma_by_fraction(a, x);
}

double chi_square_quantile(double probability, double freedom) {
  double low = 0.0;
  double high = freedom + 1.0;
  while (chi_square_probability(high, freedom) < probability) {
    low = high;
    high *= 2.0;
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (chi_square_probability(middle, freedom) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace rprr
