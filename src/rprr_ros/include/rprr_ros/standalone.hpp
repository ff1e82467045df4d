// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rprr {

/// Runs one nodelet as a node of its own: the whole main of our standalone nodes.
int run_standalone(int argc, char** argv, const std::string& nodelet_type);

}  // namespace rprr
