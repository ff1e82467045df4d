// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rprr {

/// P(a chi-square variable of so many degrees of freedom is at most `value`); freedom > 0.
double chi_square_probability(double value, double freedom);

/// Its inverse: the value that is not exceeded with that probability, 0 <= probability < 1. Exact
/// to about 1e-9 of itself, also for thousands of degrees of freedom.
double chi_square_quantile(double probability, double freedom);

}  // namespace rprr
