// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "rprr_eval/curves/pair_curves.hpp"

namespace rprr {

using PairPointers = std::vector<const PairCurves*>;

/// null where nothing counts, or where the middle one has no end.
nlohmann::json median_or_null(const std::vector<double>& values);
double share_of(std::size_t count, std::size_t all);

/// Medians of every method at the setting that the profile names.
nlohmann::json medians_at_profile(const PairPointers& pairs);
/// Medians of every method, point by point of its curve.
nlohmann::json median_curves(const PairPointers& pairs, double pixels);
/// Predicted depth of ours and the paper's.
nlohmann::json depth_over_pairs(const PairPointers& pairs);

}  // namespace rprr
