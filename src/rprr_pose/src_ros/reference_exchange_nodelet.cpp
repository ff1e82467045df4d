// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <string>
#include <vector>

#include "exchange_node.hpp"
#include "pose_broadcaster.hpp"
#include "pose_parameters.hpp"

namespace rprr {

/// Role of a, towards each robot of ~peers. Parameters: config/pose.yaml.
class ReferenceExchangeNodelet : public nodelet::Nodelet {
  void onInit() override {
    const ros::NodeHandle& private_nh = getPrivateNodeHandle();
    broadcaster_ = std::make_unique<PoseBroadcaster>(private_nh);
    const auto robot = private_nh.param<std::string>("robot", "eyebug_a");
    const std::vector<std::string> fallback{"eyebug_b"};
    const auto peers = private_nh.param("peers", fallback);
    std::map<std::string, std::unique_ptr<ExchangeRole>> roles;
    for (const std::string& peer : peers) {
      if (uses_previews(private_nh)) {
        roles[peer] = make_preview_reference(read_preview_options(private_nh, robot, peer));
        continue;
      }
      SamplesOptions options = read_samples_options(private_nh, robot, peer);
      // A reference that restarts must not count through numbers that its peers still remember.
      options.first_exchange = static_cast<std::uint32_t>(ros::WallTime::now().sec) << 8 | 1;
      roles[peer] = make_samples_reference(options);
    }
    node_ = std::make_unique<ExchangeNode>(
        getNodeHandle(), private_nh, "reference exchange", robot, std::move(roles), false,
        [this](const FrameDecision& decision, Health& health) {
          if (decision.action == FrameDecision::Action::kSendSparse) {
            broadcaster_->send(decision.pose, health);
          }
        });
  }

  std::unique_ptr<PoseBroadcaster> broadcaster_;
  std::unique_ptr<ExchangeNode> node_;  // last: its thread uses what is above
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::ReferenceExchangeNodelet, nodelet::Nodelet)
