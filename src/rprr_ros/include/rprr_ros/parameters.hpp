// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace rprr {

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
