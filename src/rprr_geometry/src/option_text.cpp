// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_geometry/option_text.hpp"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>

namespace rprr {
namespace {

constexpr std::size_t kLineLength = 98;

std::string number_text(double value) {
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    const bool is_short = std::strchr(text, 'e') != nullptr && std::abs(value) < 1e15 &&
                          std::abs(value) >= 1.0;  // more digits would do without an exponent
    if (std::strtod(text, nullptr) == value && !is_short) break;
  }
  std::string number = text;
  // YAML's numbers have a point; without it `1e+06` would be read as a text.
  if (number.find_first_of(".n") == std::string::npos) {
    const std::size_t exponent = number.find('e');
    number.insert(exponent == std::string::npos ? number.size() : exponent, ".0");
  }
  return number;
}

// A bound in a sentence: no exponent, and a point only where it is needed.
std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9f", value);
  std::string number = text;
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number;
}

// Whether YAML takes the text for a text without quotes.
bool is_plain(const std::string& text) {
  static const std::set<std::string> kTaken = {"true", "false", "yes", "no", "on", "off", "null"};
  if (text.empty() || std::isalpha(static_cast<unsigned char>(text[0])) == 0) return false;
  std::string lower;
  for (const char c : text) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) == 0 && c != '_' && c != '/' && c != '.' && c != '-') return false;
    lower += static_cast<char>(std::tolower(letter));
  }
  return kTaken.count(lower) == 0;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

template <typename T, typename Write>
std::string list_text(const std::vector<T>& values, const Write& write) {
  std::string text = "[";
  for (const T& value : values) text += (text.size() > 1 ? ", " : "") + write(value);
  return text + "]";
}

std::string text_of(const std::string& text) {
  return is_plain(text) ? text : quoted(text);
}

// Lines of a comment, none too long.
std::string comment(const std::string& text) {
  std::string out;
  std::string line = "#";
  std::size_t begin = 0;
  while (begin < text.size()) {
    std::size_t end = text.find_first_of(" \n", begin);
    if (end == std::string::npos) end = text.size();
    const std::string word = text.substr(begin, end - begin);
    if (line.size() + 1 + word.size() > kLineLength) {
      out += line + "\n";
      line = "#";
    }
    line += " " + word;
    if (end < text.size() && text[end] == '\n') {
      out += line + "\n";
      line = "#";
    }
    begin = end + 1;
  }
  return out + line + "\n";
}

}  // namespace

std::string yaml_text(const OptionValue& value) {
  struct Writer {
    std::string operator()(std::monostate) const { return "null"; }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(int number) const { return std::to_string(number); }
    std::string operator()(double number) const { return number_text(number); }
    std::string operator()(const std::string& text) const { return text_of(text); }
    std::string operator()(const std::vector<std::string>& texts) const {
      return list_text(texts, text_of);
    }
    std::string operator()(const std::vector<double>& numbers) const {
      return list_text(numbers, number_text);
    }
  };
  return std::visit(Writer{}, value);
}

std::string allowed_text(const Option& option) {
  if (!option.rule.empty()) return option.rule;
  const std::string range =
      short_number(option.range.least) + " to " + short_number(option.range.most);
  const std::string unit = option.unit.empty() ? "" : " " + option.unit;
  switch (option.kind) {
    case OptionKind::kSwitch:
      return "true, false";
    case OptionKind::kWhole:
      return range + unit + ", a whole number";
    case OptionKind::kNumber:
      return range + unit;
    case OptionKind::kWord: {
      std::string text;
      for (const std::string& word : option.words) text += (text.empty() ? "" : ", ") + word;
      return text;
    }
    case OptionKind::kText:
      return "a text";
    case OptionKind::kTexts:
      return "a list of texts";
    case OptionKind::kNumbers:
      break;
  }
  const auto& usual = std::get<std::vector<double>>(option.initial);
  return "a list of " + std::to_string(usual.size()) + " numbers, each " + range + unit;
}

std::string option_document(const OptionTable& table, const std::string& head) {
  std::string out = comment(head) + comment(
                                        "Made from the tables in the sources: every value here is "
                                        "the default, so a node that loads "
                                        "this file changes nothing.");
  std::string group;
  for (const Option& option : table.options()) {
    if (option.group != group) out += "\n# ---- " + option.group + "\n";
    group = option.group;
    const bool is_free = (option.kind == OptionKind::kText || option.kind == OptionKind::kTexts) &&
                         option.rule.empty();
    const std::string allowed = is_free ? "" : " Allowed: " + allowed_text(option) + ".";
    out += "\n" + comment(option.help + "." + allowed +
                          (option.live ? " May change while the node runs." : ""));
    out += (option.wiring ? "# " : "") + option.name + ": " + yaml_text(option.initial) + "\n";
  }
  return out;
}

}  // namespace rprr
