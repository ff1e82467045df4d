// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/live_options.hpp"

#include <sstream>
#include <utility>
#include <vector>

#include "rprr_geometry/option_text.hpp"

namespace rprr {
namespace {

using dynamic_reconfigure::Config;

OptionTable live_rows(const OptionTable& table) {
  OptionTable live;
  for (const Option& option : table.options()) {
    if (option.live) live.append_row(option);
  }
  return live;
}

std::string type_of(const Option& option) {
  switch (option.kind) {
    case OptionKind::kSwitch:
      return "bool";
    case OptionKind::kWhole:
      return "int";
    case OptionKind::kNumber:
      return "double";
    default:
      return "str";
  }
}

// A choice as rqt_reconfigure's clients evaluate it: the literal of a Python dictionary.
std::string edit_method(const Option& option) {
  if (option.words.empty()) return {};
  std::string words;
  for (const std::string& word : option.words) {
    std::ostringstream text;
    text << (words.empty() ? "" : ", ") << "{'name': '" << word << "', 'value': '" << word
         << "', 'type': 'str', 'description': '" << word << "'}";
    words += text.str();
  }
  return "{'enum': [" + words + "], 'enum_description': '" + option.name + "'}";
}

template <typename Parameter, typename Value>
Parameter parameter(const std::string& name, const Value& value) {
  Parameter entry;
  entry.name = name;
  entry.value = value;
  return entry;
}

void put(Config& config, const std::string& name, const OptionValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) {
    config.bools.push_back(
        parameter<dynamic_reconfigure::BoolParameter>(name, static_cast<std::uint8_t>(*flag)));
  } else if (const int* whole = std::get_if<int>(&value)) {
    config.ints.push_back(parameter<dynamic_reconfigure::IntParameter>(name, *whole));
  } else if (const double* number = std::get_if<double>(&value)) {
    config.doubles.push_back(parameter<dynamic_reconfigure::DoubleParameter>(name, *number));
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    config.strs.push_back(parameter<dynamic_reconfigure::StrParameter>(name, *text));
  }
}

// The value of an option at the least or at the most of its range.
OptionValue bound(const Option& option, bool is_most) {
  const double value = is_most ? option.range.most : option.range.least;
  switch (option.kind) {
    case OptionKind::kSwitch:
      return is_most;
    case OptionKind::kWhole:
      return static_cast<int>(value);
    case OptionKind::kNumber:
      return value;
    default:
      return std::string();
  }
}

Config with_group(Config config) {
  dynamic_reconfigure::GroupState group;
  group.name = "Default";
  group.state = 1;
  config.groups.push_back(group);
  return config;
}

void set_parameter(const ros::NodeHandle& nh, const std::string& name, const OptionValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) nh.setParam(name, *flag);
  if (const int* whole = std::get_if<int>(&value)) nh.setParam(name, *whole);
  if (const double* number = std::get_if<double>(&value)) nh.setParam(name, *number);
  if (const auto* text = std::get_if<std::string>(&value)) nh.setParam(name, *text);
}

}  // namespace

LiveOptions::LiveOptions(const ros::NodeHandle& private_nh, const OptionTable& table,
                         Refused refused, Changed changed)
    : nh_(private_nh),
      table_(live_rows(table)),
      refused_(std::move(refused)),
      changed_(std::move(changed)),
      descriptions_(
          nh_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true)),
      updates_(nh_.advertise<Config>("parameter_updates", 1, true)) {
  descriptions_.publish(description());
  updates_.publish(config());
  service_ = nh_.advertiseService("set_parameters", &LiveOptions::on_request, this);
}

LiveOptions::LiveOptions(const ros::NodeHandle& private_nh, const OptionTable& table,
                         Health& health, Changed changed)
    : LiveOptions(
          private_nh, table,
          [&health](const std::string& reason) {
            health.warn("reconfiguration", "refused: " + reason);
          },
          std::move(changed)) {
}

bool LiveOptions::on_request(Request& request, Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<OptionValue> before;
  for (const Option& option : table_.options()) before.push_back(option.get());
  std::string wrong = take(request.config);
  if (wrong.empty()) wrong = changed_();
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Option& option = table_.options()[i];
    if (!wrong.empty()) {
      option.set(before[i]);
    } else if (option.get() != before[i]) {
      set_parameter(nh_, option.name, option.get());
    }
  }
  if (!wrong.empty()) refused_(wrong);
  response.config = config();
  updates_.publish(response.config);
  return true;
}

// Empty, or what is wrong: then some options may have changed.
std::string LiveOptions::take(const Config& config) {
  std::vector<std::string> complaints;
  const auto assign = [&](const std::string& name, const OptionValue& value) {
    std::string wrong = table_.assign(name, value);
    if (!wrong.empty()) complaints.push_back(std::move(wrong));
  };
  for (const auto& entry : config.bools) assign(entry.name, entry.value != 0);
  for (const auto& entry : config.ints) assign(entry.name, entry.value);
  for (const auto& entry : config.doubles) assign(entry.name, entry.value);
  for (const auto& entry : config.strs) assign(entry.name, entry.value);
  return joined(complaints);
}

dynamic_reconfigure::ConfigDescription LiveOptions::description() const {
  dynamic_reconfigure::ConfigDescription description;
  dynamic_reconfigure::Group group;
  group.name = "Default";
  for (const Option& option : table_.options()) {
    dynamic_reconfigure::ParamDescription entry;
    entry.name = option.name;
    entry.type = type_of(option);
    entry.description = option.help + " [" + allowed_text(option) + "]";
    entry.edit_method = edit_method(option);
    group.parameters.push_back(entry);
    put(description.dflt, option.name, option.initial);
    put(description.min, option.name, bound(option, false));
    put(description.max, option.name, bound(option, true));
  }
  description.groups.push_back(group);
  description.dflt = with_group(std::move(description.dflt));
  description.min = with_group(std::move(description.min));
  description.max = with_group(std::move(description.max));
  return description;
}

Config LiveOptions::config() const {
  Config config;
  for (const Option& option : table_.options()) put(config, option.name, option.get());
  return with_group(std::move(config));
}

}  // namespace rprr
