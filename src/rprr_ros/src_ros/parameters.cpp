// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/parameters.hpp"

#include <ros/param.h>

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

}  // namespace

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
