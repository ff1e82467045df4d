// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <string>

#include "exchange_node.hpp"
#include "pose_parameters.hpp"

namespace rprr {

/// Role of b, towards the robot ~peer. Parameters: config/pose.yaml.
class DependentExchangeNodelet : public nodelet::Nodelet {
  void onInit() override {
    const ros::NodeHandle& private_nh = getPrivateNodeHandle();
    const Parameters parameters(private_nh);
    const auto robot = parameters.param<std::string>("robot", "eyebug_b");
    const auto peer = parameters.param<std::string>("peer", "eyebug_a");
    std::map<std::string, std::unique_ptr<ExchangeRole>> roles;
    if (uses_previews(parameters)) {
      PreviewOptions options = read_preview_options(parameters, robot, peer);
      // A dependent that restarts must not count through numbers that its reference remembers.
      options.first_exchange = static_cast<std::uint32_t>(ros::WallTime::now().sec) << 8 | 1;
      roles[peer] = make_preview_dependent(options);
    } else {
      roles[peer] = make_samples_dependent(read_samples_options(parameters, robot, peer));
    }
    node_ = std::make_unique<ExchangeNode>(
        getNodeHandle(), private_nh, "dependent exchange", robot, std::move(roles), true,
        parameters.param("stale_overlap", kStaleOverlap), [](const FrameDecision&, Health&) {});
  }

  std::unique_ptr<ExchangeNode> node_;
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::DependentExchangeNodelet, nodelet::Nodelet)
