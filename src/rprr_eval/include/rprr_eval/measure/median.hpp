// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace rprr {

/// Middle value (lower one of two); 0 of nothing.
double median(std::vector<double> values);

/// The value that so large a share of them, 0 to 1, does not exceed (the lower one of two); 0 of
/// nothing.
double percentile(std::vector<double> values, double share);

}  // namespace rprr
