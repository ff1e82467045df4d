// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>

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

}  // namespace rprr
