// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rprr_geometry/option_table.hpp"
#include "rprr_pose/exchange_stage.hpp"

namespace rprr {

/// Which frame of the dependent hangs below the reference's in tf.
enum class TfTarget {
  kOwn,   ///< <b>_rprr_optical_frame, which RPRR alone publishes
  kRoot,  ///< the root of b's own tree
};

/// What the exchange node of a robot needs beyond ExchangeOptions. Defaults are those of profile
/// `default`.
struct ExchangeNodeOptions {
  std::string robot = "eyebug_a";
  std::vector<std::string> peers;       ///< robots that it may exchange with
  std::vector<std::string> references;  ///< of these, the ones that it refers to at first
  double stale_overlap = 0.7;           ///< share of a view below which a pose is called stale
  bool link_recovery = true;            ///< RadioLinks look after the peers' topics
  bool publish_tf = true;               ///< accepted poses go to /tf
  TfTarget tf_target = TfTarget::kOwn;
  bool tf_prior = true;  ///< what tf knows of a pose is tried before a search
  /// "auto", or a frame; {robot} stands for the robot's name in the second.
  std::string tf_prior_fixed_frame = "auto";
  std::string tf_prior_odom_frame = "auto";

  /// Whether a robot's whole tree hangs below this one's optical frame.
  bool publishes_root() const { return publish_tf && tf_target == TfTarget::kRoot; }
};

void list_options(ExchangeOptions& options, OptionTable& table);
void list_options(ExchangeNodeOptions& options, OptionTable& table);

/// Empty, or which names do not go together: a robot that is its own peer, a reference that is none
/// of the peers.
std::string problem_of(const ExchangeNodeOptions& options);

}  // namespace rprr
