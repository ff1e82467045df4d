// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rprr_eval/pair_runner.hpp"

namespace rprr {

/// Middle value (lower one of two); 0 of nothing.
double median(std::vector<double> values);

/// The value that so large a share of them, 0 to 1, does not exceed (the lower one of two); 0 of
/// nothing.
double percentile(std::vector<double> values, double share);

/// A table for people over all pairs of a run: medians, shares, and the settings they hold for.
std::string summary_table(const std::vector<PairResult>& results, const Profile& profile);

}  // namespace rprr
