// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_pose/registration.hpp"

namespace rprr {

/// A pose method that the evaluation knows by name.
struct Method {
  std::string name;
  std::string description;
  /// Errors: what it needs is not there (a peer that was not built in, a profile).
  std::function<Result<std::unique_ptr<Registration>>()> make;
};

/// All of them: our protocols, the paper's baselines, peers. A new one is one line in methods.cpp.
const std::vector<Method>& methods();

using NamedRegistrations = std::vector<std::unique_ptr<Registration>>;

/// Makes those of the names, in their order; all that can be made if there are none. `notes` takes
/// a line for each that was left out because it is not built in. Errors: an unknown name, and,
/// where names are given, one that cannot be made.
Result<NamedRegistrations> make_methods(const std::vector<std::string>& names,
                                        std::vector<std::string>& notes);

}  // namespace rprr
