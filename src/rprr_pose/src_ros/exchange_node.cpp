// SPDX-License-Identifier: BSD-3-Clause
#include "exchange_node.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <utility>

#include "rprr_pose_ros/decision_message.hpp"
#include "rprr_pose_ros/message_conversions.hpp"
#include "rprr_pose_ros/pose_seal.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/steady_now.hpp"

namespace rprr {
namespace {

constexpr std::size_t kQueue = 200;          // jobs; an exchange is a few dozen messages at most
constexpr std::size_t kLongestData = 65536;  // [bytes] no message of an exchange comes near it
const ros::WallDuration kTick(0.02);
constexpr Duration kRadioSilence = from_seconds(5.0);  // its state comes every second

std::size_t data_size(const rprr_msgs::RelativePose&) {
  return 0;
}
template <typename Message>
std::size_t data_size(const Message& message) {
  return message.data.size();
}

// Other messages than poses are sealed inside.
bool is_intact(const rprr_msgs::RelativePose& message) {
  return message.checksum == checksum_of(message);
}
template <typename Message>
bool is_intact(const Message&) {
  return true;
}

Stamp stamp_of(const PoseMessage& message) {
  return std::visit([](const auto& any) { return any.stamp; }, message);
}

// The optical frame that the sender names; an update names none.
std::string frame_of(const PoseMessage& message) {
  if (const auto* samples = std::get_if<SamplesMessage>(&message)) return samples->frame_id;
  if (const auto* preview = std::get_if<PreviewMessage>(&message)) return preview->frame_id;
  if (const auto* pose = std::get_if<RelativePoseMessage>(&message)) return pose->frame_id;
  return {};
}

std::vector<std::string> topics_of(const std::vector<ros::Subscriber>& subscribers) {
  std::vector<std::string> topics;
  for (const ros::Subscriber& subscriber : subscribers) topics.push_back(subscriber.getTopic());
  return topics;
}

double age_of(Stamp stamp) {
  return (ros::Time::now() - to_time(stamp)).toSec();
}

}  // namespace

ExchangeNode::ExchangeNode(ros::NodeHandle nh, ros::NodeHandle private_nh,
                           const ExchangeNodeOptions& options, const InputOptions& input,
                           std::unique_ptr<ExchangeStage> stage, Observer observer)
    : nh_(nh),
      options_(options),
      health_(nh, private_nh, "exchange", options.robot),
      inputs_(nh, health_),
      observer_(std::move(observer)),
      stage_(std::move(stage)),
      clocks_(options.robot, health_),
      motion_(nh_, options.robot, options.stale_overlap, health_) {
  advertise();
  worker_ = std::make_unique<Worker>(kQueue);
  for (const std::string& peer : options_.references) set_reference(peer, true);
  for (const std::string& peer : options_.peers) {
    peer_topics_[peer] = nh_.resolveName("/" + peer + "/rprr/relative_pose");
  }
  for (const std::string& peer : options_.peers) subscribe(peer);
  if (options_.link_recovery) links_ = RadioLinks::look_after(topics_of(subscribers_));
  timer_ = nh_.createWallTimer(
      kTick, [this](const ros::WallTimerEvent&) { worker_->post([this] { on_tick(); }); });
  subscribers_.push_back(
      nh_.subscribe("/" + options_.robot + "/rprr/radio", 4, &ExchangeNode::on_radio, this));
  service_ = private_nh.advertiseService("set_reference", &ExchangeNode::on_set_reference, this);
  input_ = std::make_unique<RgbdSubscriber>(
      nh_, private_nh, options_.robot, input, health_, [this](const RgbdFramePtr& frame) {
        worker_->post([this, frame] {
          own_frame_ = frame->frame_id;
          motion_.see(frame);
          drive([&](RoleOutput& out) { stage_->offer(frame, steady_now(), out); });
        });
      });
}

void ExchangeNode::advertise() {
  const std::string prefix = "/" + options_.robot + "/rprr/";
  if (stage_->uses_previews()) {
    preview_ = nh_.advertise<rprr_msgs::BlockPreview>(prefix + "preview", 10);
  } else {
    samples_ = nh_.advertise<rprr_msgs::SamplePoints>(prefix + "samples", 10);
    update_ = nh_.advertise<rprr_msgs::PoseUpdate>(prefix + "update", 10);
  }
  pose_ = nh_.advertise<rprr_msgs::RelativePose>(prefix + "relative_pose", 10);
  decisions_ = nh_.advertise<FrameDecision>(prefix + "exchange", 10);
}

// All topics of every peer are heard, whatever its role is now: so a role that changes finds its
// topics connected.
void ExchangeNode::subscribe(const std::string& peer) {
  if (stage_->uses_previews()) {
    listen<rprr_msgs::BlockPreview>(peer, "preview");
  } else {
    listen<rprr_msgs::SamplePoints>(peer, "samples");
    listen<rprr_msgs::PoseUpdate>(peer, "update");
  }
  listen<rprr_msgs::RelativePose>(peer, "relative_pose");
  inputs_.expect(peer_topics_[peer], InputKind::kRegularly, "message of robot '" + peer + "'",
                 "start its nodes, with the same master, and look whether it is in reach");
}

template <typename Message>
void ExchangeNode::listen(const std::string& peer, const std::string& topic) {
  const boost::function<void(const ros::MessageEvent<Message const>&)> callback =
      [this, peer](const ros::MessageEvent<Message const>& event) { on_message(peer, event); };
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const ros::MessageEvent<Message const>&>(
      "/" + peer + "/rprr/" + topic, 50, callback);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(nh_.subscribe(options));
}

template <typename Message>
void ExchangeNode::on_message(const std::string& peer,
                              const ros::MessageEvent<Message const>& event) {
  const boost::shared_ptr<Message const> message = event.getConstMessage();
  const double age = (ros::Time::now() - message->header.stamp).toSec();
  inputs_.heard(peer_topics_.at(peer));
  const std::string stranger = senders_.note(ros::message_traits::datatype<Message>() + peer,
                                             event.getPublisherName(), steady_now());
  if (!stranger.empty()) health_.warn("two senders", "as '" + peer + "': " + stranger);
  if (data_size(*message) > kLongestData) {
    return health_.warn("message too long", "a message of " + peer +
                                                " is too long to be part of an "
                                                "exchange; check who publishes as that robot");
  }
  if (!is_intact(*message)) {
    return health_.warn("message of " + peer + " refused",
                        peer +
                            ": damaged pose; check the radio, that all robots run the same "
                            "version and that nobody else publishes as that robot");
  }
  worker_->post([this, peer, message, age] { take(peer, from_ros(*message), age); });
}

void ExchangeNode::on_radio(const rprr_msgs::RadioStateConstPtr& message) {
  LinkState link;
  link.has_room = message->ready != 0;
  link.frame_seconds = static_cast<double>(message->frame_seconds);
  for (const ros::Time& stamp : message->references) link.references.push_back(to_stamp(stamp));
  worker_->post([this, link] {
    radio_told_ = steady_now();
    drive([&](RoleOutput& out) { stage_->set_link_state(link, steady_now(), out); });
  });
}

bool ExchangeNode::on_set_reference(rprr_msgs::SetReference::Request& request,
                                    rprr_msgs::SetReference::Response& response) {
  const auto& peers = options_.peers;
  response.success = std::find(peers.begin(), peers.end(), request.peer) != peers.end();
  if (!response.success) {
    response.message = "'" + request.peer + "' is none of this node's ~peers";
    return true;
  }
  const bool refer = request.refer != 0;
  worker_->post([this, peer = request.peer, refer] { set_reference(peer, refer); });
  return true;
}

// From here on: the worker's thread.
void ExchangeNode::set_reference(const std::string& peer, bool refer) {
  stage_->set_reference(peer, refer);
  health_.show("refers to " + peer, refer ? "yes" : "no");
}

void ExchangeNode::take(const std::string& peer, const PoseMessage& message, double age) {
  clocks_.received(peer, message, age);
  const std::string frame = clean_frame(frame_of(message));
  if (!frame.empty() && frame == own_frame_) {
    health_.warn("frames clash", options_.robot + " and " + peer +
                                     " both call their camera's frame '" + frame +
                                     "': tf and rviz cannot tell them apart. Give each "
                                     "driver a frame of its own, such as " +
                                     optical_frame(options_.robot));
  }
  drive([&](RoleOutput& out) { stage_->receive(peer, message, steady_now(), out); });
}

void ExchangeNode::on_tick() {
  // An encoder that is gone must not keep exchanges from beginning.
  if (radio_told_ && steady_now() - *radio_told_ > kRadioSilence) {
    radio_told_.reset();
    drive([&](RoleOutput& out) { stage_->set_link_state({}, steady_now(), out); });
  }
  drive([&](RoleOutput& out) { stage_->tick(steady_now(), out); });
}

void ExchangeNode::drive(const std::function<void(RoleOutput&)>& action) {
  RoleOutput out;
  action(out);
  for (const PoseMessage& message : out.send) {
    publish(message);
    if (const auto* pose = std::get_if<RelativePoseMessage>(&message)) {
      show(pose->dependent, pose->verdict);
    }
  }
  for (const FrameDecision& decision : out.decisions) publish(decision);
  // A message is often read later than it came, so the problem says whose message it was.
  for (const MessageProblem& problem : out.problems) {
    health_.warn("message of " + problem.peer + " refused",
                 problem.peer + ": " + problem.text +
                     "; a message on a radio topic could not be used: check that all robots run "
                     "the same version and that nobody else publishes there");
  }
}

// The reference shows the verdict that it sends, the dependent the one that it was told.
void ExchangeNode::show(const std::string& peer, const PoseVerdict& verdict) {
  health_.show("last verdict with " + peer, describe(verdict));
  if (verdict.accepted()) return;
  health_.show("last rejection with " + peer, describe(verdict));
  health_.count(std::string("poses rejected, ") + name_of(verdict.status));
}

void ExchangeNode::publish(const FrameDecision& decision) {
  using Action = FrameDecision::Action;
  const bool accepted =
      decision.action == Action::kSendSparse || decision.action == Action::kPredict;
  health_.count(accepted ? "poses accepted" : "frames sent whole");
  if (!accepted) health_.show("last reason for a whole frame", decision.reason);
  if (decision.verdict) show(decision.peer, *decision.verdict);
  decisions_.publish(boost::make_shared<const FrameDecision>(decision));
  observer_(decision, health_);
  if (!accepted) return;
  // After all that came meanwhile, so that the newest frame is known. A camera that is slower than
  // the exchange has none.
  worker_->post([this, frame = decision.frame, peer = decision.peer, exchange = decision.exchange] {
    motion_.report(frame, peer, exchange);
  });
}

void ExchangeNode::publish(const PoseMessage& message) {
  PoseMessage sent = message;
  clocks_.sending(receiver_of(sent), sent, age_of(stamp_of(sent)));
  if (const auto* samples = std::get_if<SamplesMessage>(&sent)) {
    samples_.publish(to_ros(*samples));
  } else if (const auto* update = std::get_if<UpdateMessage>(&sent)) {
    update_.publish(to_ros(*update));
  } else if (const auto* preview = std::get_if<PreviewMessage>(&sent)) {
    preview_.publish(to_ros(*preview));
  } else {
    pose_.publish(to_ros(std::get<RelativePoseMessage>(sent)));
  }
}

}  // namespace rprr
