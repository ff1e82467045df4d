// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rprr_geometry/option_table.hpp"
#include "rprr_pose/preview_protocol.hpp"
#include "rprr_pose/samples_protocol.hpp"

namespace rprr {

/// How two robots find their relative pose: the protocol, and the settings of either. Defaults are
/// those of profile `default`.
struct PoseOptions {
  bool use_previews = true;  // protocol: preview, or samples
  PreviewOptions preview;
  SamplesOptions samples;
};

/// Which frame of the dependent hangs below the reference's in tf.
enum class TfTarget {
  kOwn,   // <b>_rprr_optical_frame, which RPRR alone publishes
  kRoot,  // the root of b's own tree
};

/// What the exchange of a robot needs beyond PoseOptions.
struct ExchangeOptions {
  std::string robot = "eyebug_a";
  std::vector<std::string> peers;       // robots that it may exchange with
  std::vector<std::string> references;  // of these, the ones that it refers to from the start
  double stale_overlap = 0.7;           // share of a view below which a pose is called stale
  bool publish_tf = true;
  TfTarget tf_target = TfTarget::kOwn;
  bool tf_prior = true;
  /// "auto", or a frame; {robot} stands for the robot's name in the second.
  std::string tf_prior_fixed_frame = "auto";
  std::string tf_prior_odom_frame = "auto";
};

void list_options(PoseOptions& options, OptionTable& table);
void list_options(ExchangeOptions& options, OptionTable& table);

}  // namespace rprr
