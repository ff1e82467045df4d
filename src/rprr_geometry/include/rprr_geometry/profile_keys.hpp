// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rprr {

/// All parameters that a profile may set, sorted. A profile is one flat file that every node and
/// rprr_eval load whole: each takes its own parameters from it, and this list tells the parameters
/// of the others from misspelt ones. A test of rprr_eval holds it against the tables.
const std::vector<std::string>& profile_keys();

}  // namespace rprr
