// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <map>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "exchange_node.hpp"
#include "pose_broadcaster.hpp"
#include "pose_parameters.hpp"
#include "tf_prior.hpp"

namespace rprr {

/// The pose stage of a robot, towards all its peers. Parameters: config/pose.yaml.
class ExchangeNodelet : public nodelet::Nodelet {
  void onInit() override {
    const ros::NodeHandle& private_nh = getPrivateNodeHandle();
    ExchangeParameters parameters;
    const std::string wrong = read_exchange_parameters(private_nh, parameters);
    const ExchangeNodeOptions& options = parameters.node;
    if (!wrong.empty()) {
      refusal_ = std::make_unique<Health>(getNodeHandle(), private_nh, "exchange", options.robot);
      return refusal_->refuse_parameters(wrong);
    }
    const bool uses_prior = parameters.exchange.use_previews && options.tf_prior;
    if (options.publishes_root() || uses_prior) {
      listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
    }
    broadcaster_ = std::make_unique<PoseBroadcaster>(options, &buffer_);
    for (const std::string& peer : options.peers) {
      const auto tf = tf_prior_options(options, peer);
      if (tf && uses_prior) priors_[peer] = std::make_unique<TfPrior>(buffer_, *tf);
    }
    node_ = std::make_unique<ExchangeNode>(
        getNodeHandle(), private_nh, options, parameters.input,
        std::make_unique<ExchangeStage>(options.robot, parameters.exchange, options.peers, prior()),
        [this](const FrameDecision& decision, Health& health) { on_decision(decision, health); });
  }

  PosePrior prior() {
    if (priors_.empty()) return {};
    return [this](const std::string& peer, const FrameNames& frames,
                  const std::optional<KnownPose>& last) {
      const auto found = priors_.find(peer);
      return found == priors_.end() ? std::vector<Pose>() : found->second->propose(frames, last);
    };
  }

  // The reference of a pair tells tf of their pose.
  void on_decision(const FrameDecision& decision, Health& health) {
    if (decision.action == FrameDecision::Action::kPredict) {
      broadcaster_->send(decision.pose, health);
    }
    const auto prior = priors_.find(decision.peer);
    if (prior == priors_.end()) return;
    const std::string complaint = prior->second->take_complaint();
    if (!complaint.empty()) health.warn("tf prior of " + decision.peer, complaint);
  }

  std::unique_ptr<Health> refusal_;  // null: the parameters are in order
  tf2_ros::Buffer buffer_;           // stays empty without a listener
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::unique_ptr<PoseBroadcaster> broadcaster_;
  std::map<std::string, std::unique_ptr<TfPrior>> priors_;  // by peer; the worker's thread
  std::unique_ptr<ExchangeNode> node_;                      // last: its thread uses what is above
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::ExchangeNodelet, nodelet::Nodelet)
