// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <optional>
#include <string>

#include "rprr_geometry/option_table.hpp"
#include "rprr_pose/pose_options.hpp"
#include "rprr_ros/input_options.hpp"

namespace rprr {

struct TfPriorOptions;

struct ExchangeParameters {
  ExchangeNodeOptions node;
  ExchangeOptions exchange;
  InputOptions input;
};

/// All private parameters of the exchange's node: config/pose.yaml.
OptionTable table_of(ExchangeParameters& parameters);

/// Reads them, and numbers exchanges from the clock. Empty, or what is wrong.
std::string read_exchange_parameters(const ros::NodeHandle& private_nh,
                                     ExchangeParameters& parameters);

/// What tf may propose as first poses towards `peer`; none if ~tf_prior is false.
std::optional<TfPriorOptions> tf_prior_options(const ExchangeNodeOptions& options,
                                               const std::string& peer);

}  // namespace rprr
