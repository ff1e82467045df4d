// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rprr_geometry/option_table.hpp"

namespace rprr {

/// A value as YAML writes it: `0.5`, `true`, `[a, b]`, quoted where YAML would else take a text for
/// something different. Numbers that are no whole numbers keep their point.
std::string yaml_text(const OptionValue& value);

/// What an option may be: "true, false", "0.0005 to 0.05 1/m", "fixed, map, view".
std::string allowed_text(const Option& option);

/// A YAML file that documents a table: for each option its help, unit, range and default. Loaded
/// into a node it changes nothing. Options of the wiring are comments in it. `head`: the first
/// comment, lines of it separated by newlines.
std::string option_document(const OptionTable& table, const std::string& head);

}  // namespace rprr
