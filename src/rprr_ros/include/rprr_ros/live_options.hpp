// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <functional>
#include <mutex>
#include <string>

#include "rprr_geometry/option_table.hpp"
#include "rprr_ros/health.hpp"

namespace rprr {

/// The live options of a table as dynamic_reconfigure shows and changes them: rqt_reconfigure,
/// dynparam and dynamic_reconfigure's clients work with it as with a server made from a .cfg file.
///
/// A request is taken as a whole or not at all: what the table or the node refuses leaves every
/// option as it was and is reported. What is taken also goes to the parameter server, so that a
/// node which is started again keeps it.
class LiveOptions {
 public:
  /// Called after options have changed. Empty, or why the node refuses them: then they are put back
  /// and it is not called again.
  using Changed = std::function<std::string()>;

  /// Called with the reason of a request that was refused.
  using Refused = std::function<void(const std::string& reason)>;

  /// The structs that the table is bound to must outlive this. Requests are served on the node
  /// handle's callback queue; the structs are written there alone, and both functions are called
  /// there.
  LiveOptions(const ros::NodeHandle& private_nh, const OptionTable& table, Refused refused,
              Changed changed);
  /// The same; what is refused is a warning of health, which must outlive this.
  LiveOptions(const ros::NodeHandle& private_nh, const OptionTable& table, Health& health,
              Changed changed);

 private:
  using Request = dynamic_reconfigure::Reconfigure::Request;
  using Response = dynamic_reconfigure::Reconfigure::Response;

  bool on_request(Request& request, Response& response);
  std::string take(const dynamic_reconfigure::Config& config);
  dynamic_reconfigure::ConfigDescription description() const;
  dynamic_reconfigure::Config config() const;

  ros::NodeHandle nh_;
  OptionTable table_;  // the live rows
  Refused refused_;
  Changed changed_;
  std::mutex mutex_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::ServiceServer service_;
};

}  // namespace rprr
