// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/parameters.hpp"

#include <ros/param.h>

#include <algorithm>
#include <map>

#include "rprr_geometry/profile_keys.hpp"

namespace rprr {
namespace {

using XmlRpc::XmlRpcValue;

bool convert(XmlRpcValue& from, bool& to) {
  if (from.getType() != XmlRpcValue::TypeBoolean) return false;
  to = static_cast<bool>(from);
  return true;
}

bool convert(XmlRpcValue& from, int& to) {
  if (from.getType() == XmlRpcValue::TypeDouble) {
    const double value = static_cast<double>(from);
    to = static_cast<int>(value);
    return static_cast<double>(to) == value;
  }
  if (from.getType() != XmlRpcValue::TypeInt) return false;
  to = static_cast<int>(from);
  return true;
}

bool convert(XmlRpcValue& from, double& to) {
  if (from.getType() == XmlRpcValue::TypeInt) {
    to = static_cast<int>(from);
    return true;
  }
  if (from.getType() != XmlRpcValue::TypeDouble) return false;
  to = static_cast<double>(from);
  return true;
}

bool convert(XmlRpcValue& from, std::string& to) {
  if (from.getType() != XmlRpcValue::TypeString) return false;
  to = static_cast<std::string>(from);
  return true;
}

bool convert(XmlRpcValue& from, std::vector<std::string>& to) {
  if (from.getType() != XmlRpcValue::TypeArray) return false;
  to.resize(static_cast<std::size_t>(from.size()));
  for (int i = 0; i < from.size(); ++i) {
    if (!convert(from[i], to[static_cast<std::size_t>(i)])) return false;
  }
  return true;
}

// Lists of one kind; an empty one is of texts.
OptionValue option_list(XmlRpcValue list) {
  std::vector<std::string> texts;
  std::vector<double> numbers;
  for (int i = 0; i < list.size(); ++i) {
    std::string text;
    double number = 0.0;
    if (convert(list[i], text)) {
      texts.push_back(std::move(text));
    } else if (convert(list[i], number)) {
      numbers.push_back(number);
    } else {
      return {};
    }
  }
  if (numbers.empty()) return texts;
  return texts.empty() ? OptionValue(numbers) : OptionValue();
}

}  // namespace

OptionValue option_value(const XmlRpcValue& given) {
  XmlRpcValue value = given;  // its reading functions are not const
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value);
    case XmlRpcValue::TypeInt:
      return static_cast<int>(value);
    case XmlRpcValue::TypeDouble:
      return static_cast<double>(value);
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpcValue::TypeArray:
      return option_list(value);
    default:
      return {};
  }
}

std::string read_parameters(const ros::NodeHandle& private_nh, const OptionTable& table) {
  XmlRpcValue all;
  if (!ros::param::get(private_nh.getNamespace(), all)) return {};
  if (all.getType() != XmlRpcValue::TypeStruct) return {};
  std::map<std::string, OptionValue> values;
  for (auto& [name, value] : all) {
    if (value.getType() == XmlRpcValue::TypeStruct && table.find(name) == nullptr) continue;
    values[name] = option_value(value);
  }
  std::vector<std::string> elsewhere = profile_keys();
  elsewhere.emplace_back("diagnostic_period");
  return joined(assign_all(table, values, elsewhere));
}

Parameters::Parameters(const ros::NodeHandle& private_nh) {
  if (!ros::param::get(private_nh.getNamespace(), values_)) values_.clear();
}

template <typename T>
T Parameters::param(const std::string& name, const T& fallback) const {
  if (values_.getType() != XmlRpcValue::TypeStruct || !values_.hasMember(name)) return fallback;
  T value{};
  return convert(values_[name], value) ? value : fallback;
}

template bool Parameters::param(const std::string&, const bool&) const;
template int Parameters::param(const std::string&, const int&) const;
template double Parameters::param(const std::string&, const double&) const;
template std::string Parameters::param(const std::string&, const std::string&) const;
template std::vector<std::string> Parameters::param(const std::string&,
                                                    const std::vector<std::string>&) const;

}  // namespace rprr
