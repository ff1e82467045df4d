// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "rprr_geometry/stamp.hpp"

namespace rprr {

/// A value as YAML, ROS's parameter server or a slider gives it. monostate: of a kind that no
/// option has, such as a date or a list of mixed kinds. An empty list is a list of texts.
using OptionValue = std::variant<std::monostate, bool, int, double, std::string,
                                 std::vector<std::string>, std::vector<double>>;

enum class OptionKind {
  kSwitch,   // true or false
  kWhole,    // a whole number
  kNumber,   // any number; whole ones are numbers too
  kWord,     // one of a few words
  kText,     // any text
  kTexts,    // a list of texts
  kNumbers,  // a list of as many numbers as there are by default
};

struct OptionRange {
  double least = 0.0;
  double most = 0.0;
};

/// One parameter of a stage: what it is called, what it may be, and where it is kept.
struct Option {
  std::string name;
  std::string group;  // heading in the documentation; empty: none
  std::string unit;   // "m", "s", "1/m", "bytes"; empty: a plain number or none
  std::string help;   // one line, a sentence without its full stop
  OptionKind kind = OptionKind::kSwitch;
  OptionRange range;               // kWhole, kNumber, kNumbers: bounds included
  std::vector<std::string> words;  // kWord
  /// Refuses what kind, range and words would let pass. `rule` then says in words what is allowed.
  std::function<bool(const OptionValue&)> accepts;
  std::string rule;
  bool live = false;    // may change while a node runs
  bool wiring = false;  // says who a node is or whom it hears: no profile may set it
  OptionValue initial;  // the default
  std::function<OptionValue()> get;
  std::function<void(const OptionValue&)> set;  // takes what assign() has checked

  Option& as_live() {
    live = true;
    return *this;
  }
  Option& as_wiring() {
    wiring = true;
    return *this;
  }
  Option& only_if(std::function<bool(const OptionValue&)> test, std::string in_words) {
    accepts = std::move(test);
    rule = std::move(in_words);
    return *this;
  }
};

/// The parameters of one or more options structs, bound to objects of them: these must outlive the
/// table. What reads parameters, documents them or changes them at run time works on tables alone,
/// so that all of it agrees.
///
/// A struct `T` that has a table comes with a function `list_options(T&, OptionTable&)`, which adds
/// a row for each parameter; options_of(T&) makes the table.
class OptionTable {
 public:
  /// Rows that follow stand under this heading.
  void group(std::string heading) { group_ = std::move(heading); }

  Option& flag(std::string name, bool& field, std::string help);
  template <typename Whole>
  Option& whole(std::string name, Whole& field, OptionRange range, std::string unit,
                std::string help);
  Option& number(std::string name, double& field, OptionRange range, std::string unit,
                 std::string help);
  Option& number(std::string name, float& field, OptionRange range, std::string unit,
                 std::string help);
  /// Seconds, kept in all of the fields; the first one is read.
  Option& seconds(std::string name, std::vector<Duration*> fields, OptionRange range,
                  std::string help);
  Option& seconds(std::string name, Duration& field, OptionRange range, std::string help);
  template <typename Enum>
  Option& word(std::string name, Enum& field, std::vector<std::pair<std::string, Enum>> words,
               std::string help);
  Option& word(std::string name, std::string& field, std::vector<std::string> words,
               std::string help);
  Option& text(std::string name, std::string& field, std::string help);
  /// A text that is_robot_name() accepts.
  Option& robot(std::string name, std::string& field, std::string help);
  Option& texts(std::string name, std::vector<std::string>& field, std::string help);
  template <std::size_t count>
  Option& numbers(std::string name, std::array<double, count>& field, OptionRange range,
                  std::string unit, std::string help);
  /// A row whose value is kept in a form of its own.
  Option& add(Option option);

  void append(OptionTable other);
  /// A row of another table, bound to the same field, with its group and default.
  void append_row(Option option) { options_.push_back(std::move(option)); }
  const std::vector<Option>& options() const { return options_; }
  /// Null: there is none of that name.
  const Option* find(const std::string& name) const;

  /// Empty, or what is wrong, naming the option and what is allowed; then nothing is changed. A
  /// whole number is taken for a number; no other kind is taken for another.
  std::string assign(const std::string& name, const OptionValue& value) const;

  /// Takes over the defaults of a table of the same rows.
  void take_defaults(const OptionTable& other);

 private:
  std::string group_;
  std::vector<Option> options_;
};

/// The table of an options struct. Defaults are those of a new T, whatever `options` holds.
template <typename T>
OptionTable options_of(T& options) {
  T fresh;
  OptionTable defaults;
  list_options(fresh, defaults);
  OptionTable table;
  list_options(options, table);
  table.take_defaults(defaults);
  return table;
}

/// Assigns every value. Names that the table does not know are errors unless they are in
/// `elsewhere`: parameters of other nodes, which a profile may hold as well. Returns what is wrong,
/// an entry for each name; the other values are assigned.
std::vector<std::string> assign_all(const OptionTable& table,
                                    const std::map<std::string, OptionValue>& values,
                                    const std::vector<std::string>& elsewhere);

/// Several complaints as one sentence.
std::string joined(const std::vector<std::string>& complaints);

/// Whether a text can name a robot, which becomes a part of topics: a letter, then letters, digits
/// and underscores.
bool is_robot_name(const std::string& text);
/// Robots that a node hears or serves: names of robots, none of them twice.
bool are_robot_names(const OptionValue& value);
constexpr const char* kRobotNameRule =
    "a name of letters, digits and underscores that begins with a letter";
constexpr const char* kRobotNamesRule =
    "a list of names of letters, digits and underscores that begin with a letter, none twice";

/// A float as the shortest decimal number that it is read from.
double as_written(float value);

template <typename Whole>
Option& OptionTable::whole(std::string name, Whole& field, OptionRange range, std::string unit,
                           std::string help) {
  static_assert(std::is_integral_v<Whole> && !std::is_same_v<Whole, bool>);
  Option option;
  option.name = std::move(name);
  option.kind = OptionKind::kWhole;
  option.range = range;
  option.unit = std::move(unit);
  option.help = std::move(help);
  option.get = [&field] { return OptionValue(static_cast<int>(field)); };
  option.set = [&field](const OptionValue& value) {
    field = static_cast<Whole>(std::get<int>(value));
  };
  return add(std::move(option));
}

template <typename Enum>
Option& OptionTable::word(std::string name, Enum& field,
                          std::vector<std::pair<std::string, Enum>> words, std::string help) {
  Option option;
  option.name = std::move(name);
  option.kind = OptionKind::kWord;
  option.help = std::move(help);
  for (const auto& [text, value] : words) option.words.push_back(text);
  option.get = [&field, words] {
    for (const auto& [text, value] : words) {
      if (value == field) return OptionValue(text);
    }
    return OptionValue();
  };
  option.set = [&field, words](const OptionValue& chosen) {
    for (const auto& [text, value] : words) {
      if (text == std::get<std::string>(chosen)) field = value;
    }
  };
  return add(std::move(option));
}

template <std::size_t count>
Option& OptionTable::numbers(std::string name, std::array<double, count>& field, OptionRange range,
                             std::string unit, std::string help) {
  Option option;
  option.name = std::move(name);
  option.kind = OptionKind::kNumbers;
  option.range = range;
  option.unit = std::move(unit);
  option.help = std::move(help);
  option.get = [&field] { return OptionValue(std::vector<double>(field.begin(), field.end())); };
  option.set = [&field](const OptionValue& value) {
    const auto& given = std::get<std::vector<double>>(value);
    for (std::size_t i = 0; i < count; ++i) field[i] = given[i];
  };
  return add(std::move(option));
}

}  // namespace rprr
