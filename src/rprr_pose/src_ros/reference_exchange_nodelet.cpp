// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <pluginlib/class_list_macros.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exchange_node.hpp"
#include "pose_broadcaster.hpp"
#include "pose_parameters.hpp"
#include "tf_prior.hpp"

namespace rprr {

/// Role of a, towards each robot of ~peers. Parameters: config/pose.yaml.
class ReferenceExchangeNodelet : public nodelet::Nodelet {
  void onInit() override {
    const ros::NodeHandle& private_nh = getPrivateNodeHandle();
    parameters_ = std::make_unique<Parameters>(private_nh);
    const Parameters& parameters = *parameters_;
    const auto robot = parameters.param<std::string>("robot", "eyebug_a");
    const std::vector<std::string> fallback{"eyebug_b"};
    const auto peers = parameters.param("peers", fallback);
    const bool previews = uses_previews(parameters);
    if (PoseBroadcaster::publishes_root(parameters) ||
        (previews && parameters.param("tf_prior", true))) {
      listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
    }
    broadcaster_ = std::make_unique<PoseBroadcaster>(parameters, &buffer_);
    std::map<std::string, std::unique_ptr<ExchangeRole>> roles;
    for (const std::string& peer : peers) {
      roles[peer] = previews ? preview_role(robot, peer) : samples_role(robot, peer);
    }
    node_ = std::make_unique<ExchangeNode>(
        getNodeHandle(), private_nh, "reference exchange", robot, std::move(roles), false,
        parameters.param("stale_overlap", kStaleOverlap),
        [this](const FrameDecision& decision, Health& health) { on_decision(decision, health); });
  }

  std::unique_ptr<ExchangeRole> samples_role(const std::string& robot, const std::string& peer) {
    SamplesOptions options = read_samples_options(*parameters_, robot, peer);
    // A reference that restarts must not count through numbers that its peers still remember.
    options.first_exchange = static_cast<std::uint32_t>(ros::WallTime::now().sec) << 8 | 1;
    return make_samples_reference(options);
  }

  std::unique_ptr<ExchangeRole> preview_role(const std::string& robot, const std::string& peer) {
    const PreviewOptions options = read_preview_options(*parameters_, robot, peer);
    const auto tf = read_tf_prior_options(*parameters_, robot, peer);
    if (!tf) return make_preview_reference(options);
    auto& prior = priors_[peer] = std::make_unique<TfPrior>(buffer_, *tf);
    return make_preview_reference(
        options,
        [&prior = *prior](const FrameNames& frames, const std::optional<KnownMotion>& last) {
          return prior.propose(frames, last);
        });
  }

  void on_decision(const FrameDecision& decision, Health& health) {
    if (decision.action == FrameDecision::Action::kSendSparse) {
      broadcaster_->send(decision.pose, health);
    }
    const auto prior = priors_.find(decision.peer);
    if (prior == priors_.end()) return;
    const std::string complaint = prior->second->take_complaint();
    if (!complaint.empty()) health.warn("tf prior of " + decision.peer, complaint);
  }

  std::unique_ptr<Parameters> parameters_;
  tf2_ros::Buffer buffer_;  // stays empty without a listener
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::unique_ptr<PoseBroadcaster> broadcaster_;
  std::map<std::string, std::unique_ptr<TfPrior>> priors_;  // by peer; the worker's thread
  std::unique_ptr<ExchangeNode> node_;                      // last: its thread uses what is above
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::ReferenceExchangeNodelet, nodelet::Nodelet)
