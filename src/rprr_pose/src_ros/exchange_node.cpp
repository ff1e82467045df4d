// SPDX-License-Identifier: BSD-3-Clause
#include "exchange_node.hpp"

#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "rprr_pose_ros/message_conversions.hpp"
#include "rprr_pose_ros/pose_seal.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/parameters.hpp"

namespace rprr {
namespace {

constexpr std::size_t kQueue = 200;          // jobs; an exchange is a few dozen messages at most
constexpr std::size_t kLongestData = 65536;  // bytes; no message of an exchange comes near it
const ros::WallDuration kTick(0.02);
constexpr Duration kRadioSilence = from_seconds(5.0);  // its state comes every second
constexpr double kClocksApart = 0.02;                  // seconds; the pairing of frames suffers

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

// The others are sealed inside.
bool is_intact(const rprr_msgs::RelativePose& message) {
  return message.checksum == checksum_of(message);
}
template <typename Message>
bool is_intact(const Message&) {
  return true;
}

}  // namespace

ExchangeNode::ExchangeNode(ros::NodeHandle nh, ros::NodeHandle private_nh, const std::string& name,
                           const std::string& robot,
                           std::map<std::string, std::unique_ptr<ExchangeRole>> roles,
                           bool listen_to_poses, double stale_overlap, Observer observer)
    : nh_(nh),
      robot_(robot),
      health_(nh, private_nh, name, robot),
      observer_(std::move(observer)),
      motion_(nh_, robot, stale_overlap, health_) {
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
  timer_ = nh_.createWallTimer(
      kTick, [this](const ros::WallTimerEvent&) { worker_->post([this] { on_tick(); }); });
  subscribers_.push_back(nh_.subscribe(prefix + "radio", 4, &ExchangeNode::on_radio, this));
  const Parameters parameters(private_nh);
  InputOptions input;
  input.max_stamp_difference = parameters.param("max_stamp_difference", 0.02);
  input.depth_unit = parameters.param("depth_unit", input.depth_unit);
  input.image_transport = parameters.param("image_transport", input.image_transport);
  input_ = std::make_unique<RgbdSubscriber>(nh_, private_nh, robot, input, health_,
                                            [this](const RgbdFramePtr& frame) { on_frame(frame); });
}

void ExchangeNode::subscribe(const std::string& peer, bool listen_to_poses) {
  const std::string prefix = "/" + peer + "/rprr/";
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  const auto listen = [&](const std::string& topic, auto tag) {
    using Message = decltype(tag);
    const boost::function<void(const ros::MessageEvent<Message const>&)> callback =
        [this, peer](const ros::MessageEvent<Message const>& event) { on_message(peer, event); };
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const ros::MessageEvent<Message const>&>(prefix + topic, 50,
                                                                            callback);
    options.transport_hints = hints;
    subscribers_.push_back(nh_.subscribe(options));
  };
  listen("samples", rprr_msgs::SamplePoints());
  listen("update", rprr_msgs::PoseUpdate());
  listen("preview", rprr_msgs::BlockPreview());
  if (listen_to_poses) listen("relative_pose", rprr_msgs::RelativePose());
}

void ExchangeNode::on_frame(const RgbdFramePtr& frame) {
  worker_->post([this, frame = to_pose_frame(frame)] {
    motion_.see(frame);
    for (const auto& [peer, side] : sides_) {
      drive(peer, [&frame](ExchangeRole& role, RoleOutput& out) {
        role.offer(frame, steady_now(), out);
      });
    }
  });
}

template <typename Message>
void ExchangeNode::on_message(const std::string& peer,
                              const ros::MessageEvent<Message const>& event) {
  const boost::shared_ptr<Message const> message = event.getConstMessage();
  const double age = (ros::Time::now() - message->header.stamp).toSec();
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
  worker_->post([this, peer, message, age] {
    const PoseMessage received = from_ros(*message);
    time_message(peer, received, age);
    drive(peer, [&received](ExchangeRole& role, RoleOutput& out) {
      role.receive(received, steady_now(), out);
    });
  });
}

void ExchangeNode::on_radio(const rprr_msgs::RadioStateConstPtr& message) {
  RadioState radio;
  radio.ready = message->ready != 0;
  radio.frame_seconds = static_cast<double>(message->frame_seconds);
  for (const ros::Time& stamp : message->references) radio.references.push_back(to_stamp(stamp));
  worker_->post([this, radio] {
    radio_told_ = steady_now();
    set_radio(radio);
  });
}

// From here on: the worker's thread.
void ExchangeNode::set_radio(const RadioState& radio) {
  for (const auto& [peer, side] : sides_) {
    drive(peer, [&radio](ExchangeRole& role, RoleOutput& out) {
      role.set_radio(radio, steady_now(), out);
    });
  }
}

void ExchangeNode::on_tick() {
  // An encoder that is gone must not keep exchanges from beginning.
  if (radio_told_ != 0 && steady_now() - radio_told_ > kRadioSilence) {
    radio_told_ = 0;
    set_radio({});
  }
  for (const auto& [peer, side] : sides_) {
    drive(peer, [](ExchangeRole& role, RoleOutput& out) { role.tick(steady_now(), out); });
  }
}

// age: by this robot's clock, of the frame that the message belongs to.
void ExchangeNode::time_message(const std::string& peer, const PoseMessage& message, double age) {
  Side& side = sides_[peer];
  const auto* pose = std::get_if<RelativePoseMessage>(&message);
  if (pose == nullptr) {
    side.question_age = age;
  } else if (pose->dependent == robot_ && pose->dependent_age != 0.0) {
    side.clock.add(pose->dependent_age - side.question_delay,
                   age - static_cast<double>(pose->reply_delay), steady_now());
    compare_clocks(peer, side);
  }
}

void ExchangeNode::compare_clocks(const std::string& peer, Side& side) {
  const auto clock = side.clock.estimate(steady_now());
  if (!clock) return;
  const auto ms = std::lround(clock->offset * 1e3);
  health_.show("clock of " + peer + " is ahead, ms", std::to_string(ms));
  health_.show("clock of " + peer + " is ahead, ms uncertain",
               std::to_string(static_cast<int>(std::lround(clock->uncertainty * 1e3))));
  if (std::abs(clock->offset) - clock->uncertainty < kClocksApart) return;
  health_.warn("clocks differ", "the clock of '" + peer + "' is " + std::to_string(std::abs(ms)) +
                                    (ms > 0 ? " ms ahead of" : " ms behind") +
                                    " this robot's, so frames of different instants are paired, or "
                                    "none: keep both together with chrony");
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
  for (const PoseMessage& message : output.send) publish(sides_[peer], message);
  for (const FrameDecision& decision : output.decisions) {
    const bool sparse = decision.action == FrameDecision::Action::kSendSparse;
    health_.count(sparse ? "poses accepted" : "frames sent whole");
    if (!sparse) health_.show("last reason for a whole frame", decision.reason);
    event_.publish(to_event(decision, ms));
    observer_(decision, health_);
    if (sparse) report_motion(decision);
  }
  for (const std::string& problem : output.problems) {
    health_.warn("message of " + peer + " refused",
                 problem +
                     "; a message on a radio topic could not be used: check that all robots run "
                     "the same version and that nobody else publishes there");
  }
}

// After all that came meanwhile, so that the newest frame is known. A camera that is slower than
// the exchange has none.
void ExchangeNode::report_motion(const FrameDecision& decision) {
  worker_->post([this, frame = decision.frame, peer = decision.peer, exchange = decision.exchange] {
    motion_.report(frame, peer, exchange);
  });
}

void ExchangeNode::publish(Side& side, const PoseMessage& message) {
  const auto age = [](Stamp stamp) { return (ros::Time::now() - to_time(stamp)).toSec(); };
  if (const auto* samples = std::get_if<SamplesMessage>(&message)) {
    side.question_delay = age(samples->stamp);
    samples_.publish(to_ros(*samples));
  } else if (const auto* update = std::get_if<UpdateMessage>(&message)) {
    update_.publish(to_ros(*update));
  } else if (const auto* preview = std::get_if<PreviewMessage>(&message)) {
    side.question_delay = age(preview->stamp);
    preview_.publish(to_ros(*preview));
  } else {
    RelativePoseMessage pose = std::get<RelativePoseMessage>(message);
    pose.dependent_age = side.question_age;
    pose.reply_delay = static_cast<float>(age(pose.stamp));
    pose_.publish(to_ros(pose));
  }
}

}  // namespace rprr
