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

/// Whom a robot's redundancy node serves.
struct RedundancyWiring {
  std::string robot = "eyebug_a";
  std::vector<std::string> peers;
  bool link_recovery = true;  ///< RadioLinks look after the peers' topics
};

void list_options(RedundancyOptions& options, OptionTable& table);
void list_options(RedundancyWiring& wiring, OptionTable& table);

/// Empty, or which names do not go together: a robot that is its own peer.
std::string problem_of(const RedundancyWiring& wiring);

}  // namespace rprr
