// SPDX-License-Identifier: BSD-3-Clause
#include "exchange_node.hpp"

#include <chrono>
#include <utility>
#include <vector>

#include "rprr_geometry_ros/conversions.hpp"
#include "rprr_pose_ros/message_conversions.hpp"

namespace rprr {
namespace {

constexpr std::size_t kQueue = 200;          // jobs; an exchange is a few dozen messages at most
constexpr std::size_t kLongestData = 65536;  // bytes; no message of an exchange comes near it
const ros::WallDuration kTick(0.02);

// Timeouts must not follow a clock that is set or a bag that starts again.
Stamp steady_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

PoseFramePtr to_pose_frame(const RgbdFramePtr& frame) {
  auto out = std::make_shared<PoseFrame>();
  out->stamp = frame->stamp;
  out->frame_id = frame->header.frame_id;
  out->camera = frame->camera;
  out->depth = frame->depth;
  out->bgr = frame->bgr;
  out->owner = frame;
  return out;
}

std::size_t data_size(const rprr_msgs::RelativePose&) {
  return 0;
}
template <typename Message>
std::size_t data_size(const Message& message) {
  return message.data.size();
}

}  // namespace

ExchangeNode::ExchangeNode(ros::NodeHandle nh, ros::NodeHandle private_nh, const std::string& name,
                           const std::string& robot,
                           std::map<std::string, std::unique_ptr<ExchangeRole>> roles,
                           bool listen_to_poses, Observer observer)
    : nh_(nh), robot_(robot), health_(nh, private_nh, name, robot), observer_(std::move(observer)) {
  const std::string prefix = "/" + robot + "/rprr/";
  samples_ = nh_.advertise<rprr_msgs::SamplePoints>(prefix + "samples", 10);
  update_ = nh_.advertise<rprr_msgs::PoseUpdate>(prefix + "update", 10);
  if (!listen_to_poses)
    pose_ = nh_.advertise<rprr_msgs::RelativePose>(prefix + "relative_pose", 10);
  preview_ = nh_.advertise<rprr_msgs::BlockPreview>(prefix + "preview", 10);
  event_ = nh_.advertise<rprr_msgs::ExchangeEvent>(prefix + "exchange", 10);
  for (auto& [peer, role] : roles) sides_[peer].role = std::move(role);
  worker_ = std::make_unique<Worker>(kQueue);
  for (const auto& [peer, side] : sides_) subscribe(peer, listen_to_poses);
  timer_ = nh_.createWallTimer(kTick, [this](const ros::WallTimerEvent&) {
    worker_->post([this] {
      for (const auto& [peer, side] : sides_) {
        drive(peer, [](ExchangeRole& role, RoleOutput& out) { role.tick(steady_now(), out); });
      }
    });
  });
  input_ = std::make_unique<RgbdSubscriber>(nh_, private_nh, robot, health_,
                                            [this](const RgbdFramePtr& frame) { on_frame(frame); });
}

void ExchangeNode::subscribe(const std::string& peer, bool listen_to_poses) {
  const std::string prefix = "/" + peer + "/rprr/";
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  const auto listen = [&](const std::string& topic, auto tag) {
    using Message = decltype(tag);
    const boost::function<void(const boost::shared_ptr<Message const>&)> callback =
        [this, peer](const boost::shared_ptr<Message const>& message) {
          on_message(peer, message);
        };
    subscribers_.push_back(
        nh_.subscribe<Message>(prefix + topic, 50, callback, ros::VoidConstPtr(), hints));
  };
  listen("samples", rprr_msgs::SamplePoints());
  listen("update", rprr_msgs::PoseUpdate());
  listen("preview", rprr_msgs::BlockPreview());
  if (listen_to_poses) listen("relative_pose", rprr_msgs::RelativePose());
}

void ExchangeNode::on_frame(const RgbdFramePtr& frame) {
  worker_->post([this, frame = to_pose_frame(frame)] {
    for (const auto& [peer, side] : sides_) {
      drive(peer, [&frame](ExchangeRole& role, RoleOutput& out) {
        role.offer(frame, steady_now(), out);
      });
    }
  });
}

template <typename Message>
void ExchangeNode::on_message(const std::string& peer,
                              const boost::shared_ptr<Message const>& message) {
  if (data_size(*message) > kLongestData) {
    return health_.warn("message too long", "a message of " + peer +
                                                " is too long to be part of an "
                                                "exchange; check who publishes as that robot");
  }
  worker_->post([this, peer, message] {
    const PoseMessage received = from_ros(*message);
    drive(peer, [&received](ExchangeRole& role, RoleOutput& out) {
      role.receive(received, steady_now(), out);
    });
  });
}

void ExchangeNode::drive(const std::string& peer,
                         const std::function<void(ExchangeRole&, RoleOutput&)>& action) {
  Side& side = sides_[peer];
  RoleOutput output;
  const Stamp start = steady_now();
  action(*side.role, output);
  side.ms += to_seconds(steady_now() - start) * 1e3;
  publish(peer, output, side.ms);
  if (!output.decisions.empty()) side.ms = 0.0;
}

void ExchangeNode::publish(const std::string& peer, const RoleOutput& output, double ms) {
  for (const PoseMessage& message : output.send) publish(message);
  for (const FrameDecision& decision : output.decisions) {
    const bool sparse = decision.action == FrameDecision::Action::kSendSparse;
    health_.count(sparse ? "poses accepted" : "frames sent whole");
    if (!sparse) health_.show("last reason for a whole frame", decision.reason);
    event_.publish(to_event(decision, ms));
    observer_(decision, health_);
  }
  for (const std::string& problem : output.problems) {
    health_.warn("message of " + peer + " refused",
                 problem +
                     "; a message on a radio topic could not be used: check that all robots run "
                     "the same version and that nobody else publishes there");
  }
}

void ExchangeNode::publish(const PoseMessage& message) {
  if (const auto* samples = std::get_if<SamplesMessage>(&message)) {
    samples_.publish(to_ros(*samples));
  } else if (const auto* update = std::get_if<UpdateMessage>(&message)) {
    update_.publish(to_ros(*update));
  } else if (const auto* preview = std::get_if<PreviewMessage>(&message)) {
    preview_.publish(to_ros(*preview));
  } else {
    pose_.publish(to_ros(std::get<RelativePoseMessage>(message)));
  }
}

}  // namespace rprr
