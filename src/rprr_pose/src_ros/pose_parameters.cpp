// SPDX-License-Identifier: BSD-3-Clause
#include "pose_parameters.hpp"

#include <ros/time.h>

#include "rprr_ros/parameters.hpp"
#include "tf_prior.hpp"

namespace rprr {

void list_options(ExchangeParameters& parameters, OptionTable& table) {
  list_options(parameters.node, table);
  list_options(parameters.exchange, table);
  list_options(parameters.input, table);
}

OptionTable table_of(ExchangeParameters& parameters) {
  return options_of(parameters);
}

std::string read_exchange_parameters(const ros::NodeHandle& private_nh,
                                     ExchangeParameters& parameters) {
  const std::string wrong = read_parameters(private_nh, table_of(parameters));
  // A robot that restarts must not count through numbers that its peers still remember.
  const std::uint32_t first = static_cast<std::uint32_t>(ros::WallTime::now().sec) << 8 | 1;
  parameters.exchange.preview.first_exchange = first;
  parameters.exchange.samples.first_exchange = first;
  return wrong.empty() ? problem_of(parameters.node) : wrong;
}

std::optional<TfPriorOptions> tf_prior_options(const ExchangeNodeOptions& given,
                                               const std::string& peer) {
  if (!given.tf_prior) return std::nullopt;
  const auto frame = [](const std::string& name) { return name == "auto" ? std::string() : name; };
  TfPriorOptions options;
  options.robot = given.robot;
  options.peer = peer;
  options.fixed_frame = frame(given.tf_prior_fixed_frame);
  options.odom_frame = frame(given.tf_prior_odom_frame);
  options.publishes_root = given.publishes_root();
  return options;
}

}  // namespace rprr
