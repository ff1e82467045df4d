// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/profile/profile.hpp"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <vector>

#include "profile/profile_folder.hpp"
#include "rprr_geometry/profile_keys.hpp"

namespace rprr {
namespace {

// A plain scalar has the kind that ROS's parameter server gives it: YAML 1.1, where a number
// without a point in its mantissa (1e6) is a text.
OptionValue scalar_value(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // in quotes
  bool flag = false;
  if (YAML::convert<bool>::decode(node, flag) && text != "y" && text != "n") return flag;
  int whole = 0;
  if (YAML::convert<int>::decode(node, whole)) return whole;
  double number = 0.0;
  const bool has_point = text.find_first_of(".") < text.find_first_of("eE");
  if (has_point && YAML::convert<double>::decode(node, number)) return number;
  return text;
}

OptionValue list_value(const YAML::Node& node) {
  std::vector<std::string> texts;
  std::vector<double> numbers;
  for (const YAML::Node& entry : node) {
    if (!entry.IsScalar()) return {};
    const OptionValue value = scalar_value(entry);
    if (const auto* text = std::get_if<std::string>(&value)) texts.push_back(*text);
    if (const int* whole = std::get_if<int>(&value)) numbers.push_back(*whole);
    if (const double* number = std::get_if<double>(&value)) numbers.push_back(*number);
  }
  if (texts.size() == node.size()) return texts;
  return numbers.size() == node.size() ? OptionValue(numbers) : OptionValue();
}

OptionValue option_value(const YAML::Node& node) {
  if (node.IsScalar()) return scalar_value(node);
  return node.IsSequence() ? list_value(node) : OptionValue();
}

// Empty, or what is wrong.
std::string read(const YAML::Node& file, Profile& profile) {
  std::map<std::string, OptionValue> values;
  for (const auto& entry : file) values[entry.first.as<std::string>()] = option_value(entry.second);
  const std::string wrong = joined(assign_all(options_of(profile), values, profile_keys()));
  if (!wrong.empty()) return wrong;
  return FrameEncoder::create(profile.codec).reason();
}

}  // namespace

void list_options(Profile& profile, OptionTable& table) {
  OptionTable all;
  list_options(static_cast<ExchangeOptions&>(profile), all);
  list_options(static_cast<RedundancyOptions&>(profile), all);
  list_options(profile.codec, all);
  list_options(profile.sending, all);
  list_options(profile.station, all);
  for (const Option& option : all.options()) {
    if (!option.wiring) table.append_row(option);
  }
}

Result<Profile> load_profile(const std::string& name_or_path) {
  std::string path = name_or_path;
  if (path.find('/') == std::string::npos && path.find('.') == std::string::npos) {
    path = profile_folder() + "/" + path + ".yaml";
  }
  if (!std::filesystem::exists(path)) {
    return Error{"no profile " + path + "; use default, paper or the path of a YAML file"};
  }
  Profile profile;
  profile.name = name_or_path;
  try {
    const YAML::Node file = YAML::LoadFile(path);
    if (!file.IsMap()) return Error{path + ": no list of `key: value` lines"};
    const std::string wrong = read(file, profile);
    if (!wrong.empty()) return Error{path + ": " + wrong};
  } catch (const YAML::Exception& error) {
    return Error{path + ": " + error.what()};
  }
  return profile;
}

}  // namespace rprr
