// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/option_table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "rprr_geometry/option_text.hpp"

namespace rprr {
namespace {

// What somebody gave, in a word.
std::string kind_of(const OptionValue& value) {
  struct Namer {
    std::string operator()(std::monostate) const { return "something of another kind"; }
    std::string operator()(bool) const { return "a truth value"; }
    std::string operator()(int) const { return "a number"; }
    std::string operator()(double) const { return "a number"; }
    std::string operator()(const std::string&) const { return "a text"; }
    std::string operator()(const std::vector<std::string>&) const { return "a list"; }
    std::string operator()(const std::vector<double>&) const { return "a list of numbers"; }
  };
  return std::visit(Namer{}, value);
}

// The value as the option's kind; monostate where it is of another one.
OptionValue as_kind(const Option& option, const OptionValue& value) {
  switch (option.kind) {
    case OptionKind::kSwitch:
      if (std::holds_alternative<bool>(value)) return value;
      break;
    case OptionKind::kWhole:
      if (std::holds_alternative<int>(value)) return value;
      break;
    case OptionKind::kNumber:
      if (const int* whole = std::get_if<int>(&value)) return static_cast<double>(*whole);
      if (std::holds_alternative<double>(value)) return value;
      break;
    case OptionKind::kWord:
    case OptionKind::kText:
      if (std::holds_alternative<std::string>(value)) return value;
      break;
    case OptionKind::kTexts:
      if (std::holds_alternative<std::vector<std::string>>(value)) return value;
      break;
    case OptionKind::kNumbers:
      if (std::holds_alternative<std::vector<double>>(value)) return value;
      break;
  }
  return {};
}

bool is_within(const OptionRange& range, double value) {
  return value >= range.least && value <= range.most;  // false for NaN
}

// Whether an option may have a value. Precondition: the value is of the option's kind.
bool is_allowed(const Option& option, const OptionValue& value) {
  if (const int* whole = std::get_if<int>(&value)) {
    if (!is_within(option.range, *whole)) return false;
  } else if (const double* number = std::get_if<double>(&value)) {
    if (!is_within(option.range, *number)) return false;
  } else if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    const auto& usual = std::get<std::vector<double>>(option.initial);
    if (numbers->size() != usual.size()) return false;
    for (const double number : *numbers) {
      if (!is_within(option.range, number)) return false;
    }
  } else if (option.kind == OptionKind::kWord) {
    const auto& word = std::get<std::string>(value);
    if (std::find(option.words.begin(), option.words.end(), word) == option.words.end()) {
      return false;
    }
  }
  return !option.accepts || option.accepts(value);
}

// Letters to change, add or leave out to make one text of the other.
std::size_t distance(const std::string& one, const std::string& other) {
  std::vector<std::size_t> row(other.size() + 1);
  for (std::size_t j = 0; j <= other.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= one.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= other.size(); ++j) {
      const std::size_t changed = diagonal + (one[i - 1] == other[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row.back();
}

std::string unknown(const std::string& name, const std::vector<std::string>& known) {
  std::string text = "unknown parameter '" + name + "'";
  std::string nearest;
  std::size_t least = std::max<std::size_t>(name.size() / 3, 1) + 1;
  for (const std::string& other : known) {
    const std::size_t letters = distance(name, other);
    if (letters >= least) continue;
    least = letters;
    nearest = other;
  }
  return nearest.empty() ? text : text + " (did you mean '" + nearest + "'?)";
}

template <typename T>
Option number_option(std::string name, T& field, OptionRange range, std::string unit,
                     std::string help) {
  Option option;
  option.name = std::move(name);
  option.kind = OptionKind::kNumber;
  option.range = range;
  option.unit = std::move(unit);
  option.help = std::move(help);
  option.set = [&field](const OptionValue& value) {
    field = static_cast<T>(std::get<double>(value));
  };
  return option;
}

Option plain_option(OptionKind kind, std::string name, std::string help) {
  Option option;
  option.name = std::move(name);
  option.kind = kind;
  option.help = std::move(help);
  return option;
}

}  // namespace

double as_written(float value) {
  char text[32];
  for (int digits = 6; digits <= 9; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, static_cast<double>(value));
    if (std::strtof(text, nullptr) == value) break;
  }
  return std::strtod(text, nullptr);
}

Option& OptionTable::add(Option option) {
  option.group = group_;
  option.initial = option.get();
  options_.push_back(std::move(option));
  return options_.back();
}

Option& OptionTable::flag(std::string name, bool& field, std::string help) {
  Option option = plain_option(OptionKind::kSwitch, std::move(name), std::move(help));
  option.get = [&field] { return OptionValue(field); };
  option.set = [&field](const OptionValue& value) { field = std::get<bool>(value); };
  return add(std::move(option));
}

Option& OptionTable::number(std::string name, double& field, OptionRange range, std::string unit,
                            std::string help) {
  Option option = number_option(std::move(name), field, range, std::move(unit), std::move(help));
  option.get = [&field] { return OptionValue(field); };
  return add(std::move(option));
}

Option& OptionTable::number(std::string name, float& field, OptionRange range, std::string unit,
                            std::string help) {
  Option option = number_option(std::move(name), field, range, std::move(unit), std::move(help));
  option.get = [&field] { return OptionValue(as_written(field)); };
  return add(std::move(option));
}

Option& OptionTable::seconds(std::string name, std::vector<Duration*> fields, OptionRange range,
                             std::string help) {
  Option option = plain_option(OptionKind::kNumber, std::move(name), std::move(help));
  option.range = range;
  option.unit = "s";
  option.get = [field = fields.front()] { return OptionValue(static_cast<double>(*field) / 1e9); };
  option.set = [fields](const OptionValue& value) {
    for (Duration* field : fields) *field = std::llround(std::get<double>(value) * 1e9);
  };
  return add(std::move(option));
}

Option& OptionTable::seconds(std::string name, Duration& field, OptionRange range,
                             std::string help) {
  return seconds(std::move(name), std::vector<Duration*>{&field}, range, std::move(help));
}

Option& OptionTable::word(std::string name, std::string& field, std::vector<std::string> words,
                          std::string help) {
  Option option = plain_option(OptionKind::kWord, std::move(name), std::move(help));
  option.words = std::move(words);
  option.get = [&field] { return OptionValue(field); };
  option.set = [&field](const OptionValue& value) { field = std::get<std::string>(value); };
  return add(std::move(option));
}

Option& OptionTable::text(std::string name, std::string& field, std::string help) {
  Option option = plain_option(OptionKind::kText, std::move(name), std::move(help));
  option.get = [&field] { return OptionValue(field); };
  option.set = [&field](const OptionValue& value) { field = std::get<std::string>(value); };
  return add(std::move(option));
}

Option& OptionTable::robot(std::string name, std::string& field, std::string help) {
  return text(std::move(name), field, std::move(help))
      .only_if([](const OptionValue& value) { return is_robot_name(std::get<std::string>(value)); },
               kRobotNameRule);
}

Option& OptionTable::texts(std::string name, std::vector<std::string>& field, std::string help) {
  Option option = plain_option(OptionKind::kTexts, std::move(name), std::move(help));
  option.get = [&field] { return OptionValue(field); };
  option.set = [&field](const OptionValue& value) {
    field = std::get<std::vector<std::string>>(value);
  };
  return add(std::move(option));
}

void OptionTable::append(OptionTable other) {
  for (Option& option : other.options_) options_.push_back(std::move(option));
}

const Option* OptionTable::find(const std::string& name) const {
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const Option& option) { return option.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

std::string OptionTable::assign(const std::string& name, const OptionValue& value) const {
  const Option* option = find(name);
  if (option == nullptr) {
    std::vector<std::string> known;
    for (const Option& other : options_) known.push_back(other.name);
    return unknown(name, known);
  }
  const OptionValue fitting = as_kind(*option, value);
  const std::string allowed = ", allowed: " + allowed_text(*option);
  if (std::holds_alternative<std::monostate>(fitting)) {
    const bool is_shown = !std::holds_alternative<std::monostate>(value);
    return name + ": " + kind_of(value) + " was given" +
           (is_shown ? " (" + yaml_text(value) + ")" : "") + allowed;
  }
  if (!is_allowed(*option, fitting)) return name + ": " + yaml_text(value) + " is not" + allowed;
  option->set(fitting);
  return {};
}

void OptionTable::take_defaults(const OptionTable& other) {
  for (std::size_t i = 0; i < options_.size(); ++i) options_[i].initial = other.options_[i].initial;
}

std::vector<std::string> assign_all(const OptionTable& table,
                                    const std::map<std::string, OptionValue>& values,
                                    const std::vector<std::string>& elsewhere) {
  std::vector<std::string> known = elsewhere;
  for (const Option& option : table.options()) known.push_back(option.name);
  std::vector<std::string> complaints;
  for (const auto& [name, value] : values) {
    std::string wrong;
    if (table.find(name) != nullptr) {
      wrong = table.assign(name, value);
    } else if (std::find(elsewhere.begin(), elsewhere.end(), name) == elsewhere.end()) {
      wrong = unknown(name, known);
    }
    if (!wrong.empty()) complaints.push_back(std::move(wrong));
  }
  return complaints;
}

std::string joined(const std::vector<std::string>& complaints) {
  std::string text;
  for (const std::string& complaint : complaints) {
    text += (text.empty() ? "" : "; ") + complaint;
  }
  return text;
}

bool is_robot_name(const std::string& text) {
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
  const auto fits = [&](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !text.empty() && is_letter(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), fits);
}

bool are_robot_names(const OptionValue& value) {
  const auto& names = std::get<std::vector<std::string>>(value);
  return std::all_of(names.begin(), names.end(), is_robot_name) &&
         std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

}  // namespace rprr
