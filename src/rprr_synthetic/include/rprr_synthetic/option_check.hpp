// SPDX-License-Identifier: BSD-3-Clause
// What holds for every table of parameters. For tests: needs gtest.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "rprr_geometry/option_table.hpp"
#include "rprr_geometry/option_text.hpp"

namespace rprr {

/// The values of all options, one after the other.
inline std::vector<OptionValue> values_of(const OptionTable& table) {
  std::vector<OptionValue> values;
  for (const Option& option : table.options()) values.push_back(option.get());
  return values;
}

/// Values that an option must refuse: of other kinds, and out of its range.
inline std::vector<OptionValue> refused_values(const Option& option) {
  std::vector<OptionValue> values = {std::monostate{}};
  const bool is_text = option.kind == OptionKind::kText || option.kind == OptionKind::kWord;
  if (option.kind != OptionKind::kSwitch) values.emplace_back(true);
  if (option.kind == OptionKind::kSwitch) values.emplace_back(0);
  if (!is_text) values.emplace_back(std::string("0"));
  if (is_text) values.emplace_back(1);
  if (option.kind == OptionKind::kWord) values.emplace_back(std::string("no such word"));
  if (option.kind == OptionKind::kWhole) {
    values.emplace_back(static_cast<int>(option.range.least) - 1);
    values.emplace_back(static_cast<int>(option.range.most) + 1);
    values.emplace_back(option.range.least);
  }
  if (option.kind == OptionKind::kNumber) {
    const double span = option.range.most - option.range.least;
    values.emplace_back(option.range.least - 0.001 * span);
    values.emplace_back(option.range.most + 0.001 * span);
    values.emplace_back(std::nan(""));
  }
  return values;
}

/// Names are unique, defaults are allowed and read back, what must be refused changes nothing, and
/// each option says what it is.
inline void check_options(const OptionTable& table) {
  std::set<std::string> names;
  for (const Option& option : table.options()) {
    SCOPED_TRACE(option.name);
    EXPECT_TRUE(names.insert(option.name).second) << "two options of one name";
    EXPECT_FALSE(option.help.empty());
    EXPECT_NE(option.help.back(), '.') << "the full stop is added where it is printed";
    EXPECT_EQ(table.assign(option.name, option.initial), "") << "the default must be allowed";
    EXPECT_EQ(option.get(), option.initial);
    for (const OptionValue& value : refused_values(option)) {
      const std::vector<OptionValue> before = values_of(table);
      const std::string wrong = table.assign(option.name, value);
      EXPECT_NE(wrong.find(option.name), std::string::npos) << yaml_text(value) << ": " << wrong;
      EXPECT_NE(wrong.find(allowed_text(option)), std::string::npos) << wrong;
      EXPECT_EQ(values_of(table), before) << yaml_text(value) << " was refused and yet changed one";
    }
  }
}

/// The file documents the table as option_document() writes it. With RPRR_UPDATE_DOCUMENTS in the
/// environment the file is written instead.
inline void check_document(const OptionTable& table, const std::string& head,
                           const std::string& path) {
  const std::string wanted = option_document(table, head);
  if (std::getenv("RPRR_UPDATE_DOCUMENTS") != nullptr) {
    std::ofstream(path) << wanted;
  }
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), wanted) << path
                                << " is out of date: run this test once with "
                                   "RPRR_UPDATE_DOCUMENTS=1";
}

}  // namespace rprr
