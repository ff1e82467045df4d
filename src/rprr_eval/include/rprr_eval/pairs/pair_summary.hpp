// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rprr_eval/pairs/pair_runner.hpp"

namespace rprr {

/// A table for people over all pairs of a run: medians, shares, and the settings they hold for.
std::string summary_table(const std::vector<PairResult>& results, const Profile& profile);

}  // namespace rprr
