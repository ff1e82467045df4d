// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rprr_geometry/option_table.hpp"
#include "rprr_redundancy/decision.hpp"
#include "rprr_redundancy/outgoing.hpp"
#include "rprr_redundancy/validation.hpp"

namespace rprr {

/// Which blocks are sent. Defaults are those of profile `default`.
struct RedundancyOptions {
  DecisionOptions decision;
  ValidationOptions validation;
  OutgoingOptions outgoing;
};

/// Who a robot's redundancy nodelet serves.
struct RedundancyWiring {
  std::string robot = "eyebug_a";
  std::vector<std::string> peers;
};

void list_options(RedundancyOptions& options, OptionTable& table);
void list_options(RedundancyWiring& options, OptionTable& table);

}  // namespace rprr
