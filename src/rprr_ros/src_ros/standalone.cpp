// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/standalone.hpp"

#include <nodelet/loader.h>
#include <ros/ros.h>

namespace rprr {

int run_standalone(int argc, char** argv, const std::string& nodelet_type) {
  std::string name = nodelet_type.substr(nodelet_type.find('/') + 1);
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  ros::init(argc, argv, name);
  nodelet::Loader loader(false);
  const nodelet::V_string arguments(argv + 1, argv + argc);
  if (!loader.load(ros::this_node::getName(), nodelet_type, ros::names::getRemappings(),
                   arguments)) {
    ROS_FATAL_STREAM("cannot load nodelet " << nodelet_type
                                            << ": is the workspace built and sourced?");
    return 1;
  }
  ros::MultiThreadedSpinner(2).spin();
  return 0;
}

}  // namespace rprr
