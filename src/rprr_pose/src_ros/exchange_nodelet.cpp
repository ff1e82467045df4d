// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
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
    const Parameters parameters(private_nh);
    const ExchangeNodeOptions options = read_node_options(parameters);
    const std::string wrong = problem_of(options);
    if (!wrong.empty()) {
      NODELET_FATAL_STREAM(wrong << "; nothing is exchanged until this is mended and restarted");
      return;
    }
    if (PoseBroadcaster::publishes_root(parameters) ||
        (options.use_previews && parameters.param("tf_prior", true))) {
      listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
    }
    broadcaster_ = std::make_unique<PoseBroadcaster>(parameters, &buffer_);
    for (const std::string& peer : options.peers) {
      const auto tf = read_tf_prior_options(parameters, options.robot, peer);
      if (tf && options.use_previews) priors_[peer] = std::make_unique<TfPrior>(buffer_, *tf);
    }
    node_ = std::make_unique<ExchangeNode>(
        getNodeHandle(), private_nh, options,
        std::make_unique<ExchangeStage>(options.robot, read_exchange_options(parameters),
                                        options.peers, prior()),
        [this](const FrameDecision& decision, Health& health) { on_decision(decision, health); });
  }

  MotionPrior prior() {
    if (priors_.empty()) return {};
    return [this](const std::string& peer, const FrameNames& frames,
                  const std::optional<KnownMotion>& last) {
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

  tf2_ros::Buffer buffer_;  // stays empty without a listener
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::unique_ptr<PoseBroadcaster> broadcaster_;
  std::map<std::string, std::unique_ptr<TfPrior>> priors_;  // by peer; the worker's thread
  std::unique_ptr<ExchangeNode> node_;                      // last: its thread uses what is above
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::ExchangeNodelet, nodelet::Nodelet)
