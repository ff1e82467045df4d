// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "rprr_geometry/option_table.hpp"

namespace rprr {

/// Reads all private parameters of a node into its table, in one call to the master. Empty, or what
/// is wrong: an unknown name, a value of another kind or out of range, each with what is allowed.
///
/// A profile is loaded whole into every node, so parameters of other nodes that a profile may set
/// (profile_keys) are no error. Neither are namespaces, which hold other libraries' parameters, nor
/// ~diagnostic_period.
std::string read_parameters(const ros::NodeHandle& private_nh, const OptionTable& table);

/// A value of the parameter server as an option takes it.
OptionValue option_value(const XmlRpc::XmlRpcValue& value);

/// A node's private parameters, fetched in one call. ros::NodeHandle::param asks the master twice
/// for each of them, which takes half a minute of starting where the master is beyond a slow radio.
/// Reads as NodeHandle does: a value of another type counts as none, but for whole numbers that
/// stand for others.
class Parameters {
 public:
  explicit Parameters(const ros::NodeHandle& private_nh);

  /// bool, int, double, std::string or a vector of strings.
  template <typename T>
  T param(const std::string& name, const T& fallback) const;
  template <typename T>
  void param(const std::string& name, T& value, const T& fallback) const {
    value = param(name, fallback);
  }

 private:
  mutable XmlRpc::XmlRpcValue values_;  // its reading functions are not const
};

}  // namespace rprr
