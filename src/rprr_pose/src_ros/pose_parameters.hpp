// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "exchange_node.hpp"
#include "rprr_pose/exchange_stage.hpp"
#include "rprr_ros/parameters.hpp"
#include "tf_prior.hpp"

namespace rprr {

/// Names, roles and protocol from the private parameters of config/pose.yaml.
ExchangeNodeOptions read_node_options(const Parameters& parameters);

/// Empty, or which names make no sense.
std::string problem_of(const ExchangeNodeOptions& options);

/// The settings of both protocols. Exchanges are numbered from the clock.
ExchangeOptions read_exchange_options(const Parameters& parameters);

/// What tf may propose to `robot` as first poses towards `peer`; none if ~tf_prior is false.
std::optional<TfPriorOptions> read_tf_prior_options(const Parameters& parameters,
                                                    const std::string& robot,
                                                    const std::string& peer);

}  // namespace rprr
