// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/parameters.hpp"

#include <ros/param.h>

#include <map>
#include <vector>

#include "rprr_geometry/profile_keys.hpp"

namespace rprr {
namespace {

using XmlRpc::XmlRpcValue;

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

}  // namespace rprr
