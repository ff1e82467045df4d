// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <rprr_msgs/BlockMask.h>

#include <boost/make_shared.hpp>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "pictures.hpp"
#include "rprr_codec_ros/outgoing_message.hpp"
#include "rprr_pose_ros/decision_message.hpp"
#include "rprr_radio_ros/radio_links.hpp"
#include "rprr_redundancy/redundancy.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/input_report.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_ros/steady_now.hpp"
#include "rprr_ros/worker.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

constexpr std::size_t kQueue = 100;  // jobs: decisions, predictions and ticks
const ros::WallDuration kTick(0.02);

}  // namespace

/// The redundancy stage of a robot: /<robot>/rprr/exchange and the peers' predictions in, the
/// robot's own predictions and /<robot>/rprr/outgoing out. Parameters: config/redundancy.yaml.
class RedundancyNodelet : public nodelet::Nodelet {
 public:
  ~RedundancyNodelet() override {
    timer_.stop();
    for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
    worker_.reset();  // its jobs use the members below
  }

 private:
  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    ros::NodeHandle& private_nh = getPrivateNodeHandle();
    RedundancyWiring wiring;
    RedundancyOptions options;
    const std::string wrong = read_options(private_nh, wiring, options);
    robot_ = wiring.robot;
    health_ = std::make_unique<Health>(nh, private_nh, "redundancy", robot_);
    inputs_ = std::make_unique<InputReport>(nh, *health_);
    if (!wrong.empty()) return health_->refuse_parameters(wrong);
    stage_ = std::make_unique<Redundancy>(robot_, options);
    pictures_ = std::make_unique<Pictures>(nh, robot_);
    const std::string prefix = "/" + robot_ + "/rprr/";
    outgoing_ = nh.advertise<OutgoingFrame>(prefix + "outgoing", 8);
    prediction_ = nh.advertise<rprr_msgs::BlockMask>(prefix + "prediction", 8);
    worker_ = std::make_unique<Worker>(kQueue);
    exchange_topic_ = nh.resolveName(prefix + "exchange");
    subscribers_.push_back(
        nh.subscribe(exchange_topic_, 16, &RedundancyNodelet::on_decision, this));
    inputs_->expect(exchange_topic_, InputKind::kRegularly, "exchanges",
                    "look at this robot's camera, and whether its rprr_pose/Exchange runs");
    std::vector<std::string> radio_topics;
    for (const std::string& peer : wiring.peers) radio_topics.push_back(subscribe(nh, peer));
    if (wiring.link_recovery) links_ = RadioLinks::look_after(radio_topics);
    timer_ = nh.createWallTimer(kTick, [this](const ros::WallTimerEvent&) {
      post([this](RedundancyOutput& out) { stage_->tick(steady_now(), out); });
    });
  }

  // Empty, or what is wrong.
  static std::string read_options(const ros::NodeHandle& private_nh, RedundancyWiring& wiring,
                                  RedundancyOptions& options) {
    OptionTable table = options_of(wiring);
    table.append(options_of(options));
    const std::string wrong = read_parameters(private_nh, table);
    return wrong.empty() ? problem_of(wiring) : wrong;
  }

  // The topic's full name.
  std::string subscribe(ros::NodeHandle& nh, const std::string& peer) {
    const boost::function<void(const rprr_msgs::BlockMaskConstPtr&)> callback =
        [this, peer](const rprr_msgs::BlockMaskConstPtr& message) { on_prediction(peer, message); };
    subscribers_.push_back(nh.subscribe<rprr_msgs::BlockMask>(
        "/" + peer + "/rprr/prediction", 8, callback, nullptr, ros::TransportHints().tcpNoDelay()));
    inputs_->expect(subscribers_.back().getTopic(), InputKind::kSometimes, "robot '" + peer + "'",
                    "start its nodes, with the same master, and look whether it is in reach");
    return subscribers_.back().getTopic();
  }

  void on_decision(const FrameDecisionConstPtr& decision) {
    inputs_->heard(exchange_topic_);
    post([this, decision](RedundancyOutput& out) { stage_->take(*decision, steady_now(), out); });
  }

  void on_prediction(const std::string& peer, const rprr_msgs::BlockMaskConstPtr& message) {
    post([this, peer, message](RedundancyOutput& out) {
      PredictionMessage prediction;
      prediction.sender = peer;
      prediction.receiver = message->receiver;
      prediction.exchange = message->exchange;
      prediction.stamp = to_stamp(message->header.stamp);
      prediction.mask = ByteView(message->data);
      prediction.frame_id_length = message->header.frame_id.size();
      stage_->receive(prediction, steady_now(), out);
    });
  }

  template <typename Action>
  void post(const Action& action) {
    const bool all_kept = worker_->post([this, action] {
      RedundancyOutput out;
      action(out);
      publish(out);
    });
    if (!all_kept) {
      health_->warn("too slow", "exchanges end faster than frames are handled; lower their rate");
    }
  }

  // From here on: the worker's thread. Requests first, since peers wait for them.
  void publish(const RedundancyOutput& out) {
    for (const BlockRequest& request : out.requests) publish(request);
    for (const OutgoingFrame& frame : out.frames) publish(frame);
    for (const ValidatedBlocks& blocks : out.validations) pictures_->show(blocks);
    for (const std::string& problem : out.problems) health_->error("exchange unusable", problem);
  }

  void publish(const BlockRequest& request) {
    auto message = boost::make_shared<rprr_msgs::BlockMask>();
    message->header.stamp = to_time(request.stamp);  // no frame_id: radio bytes
    message->receiver = request.receiver;
    message->exchange = request.exchange;
    message->data = encode_mask_pair(request.decision.send);
    prediction_.publish(message);
    health_->count("predictions");
    health_->show("last prediction, ms", std::to_string(request.ms));
    report(request.decision);
    pictures_->show(request);
  }

  void report(const BlockDecision& decision) {
    const auto show = [this](const std::string& what, int blocks) {
      health_->show("last prediction, " + what, std::to_string(blocks));
    };
    show("blocks", decision.send.colour.count());
    show("blocks of colour only", decision.send.colour.count() - decision.send.depth.count());
    show("blocks not covered", decision.uncovered);
    show("blocks outside of the view", decision.outside);
    show("blocks hidden", decision.hidden);
    show("blocks of another colour", decision.recoloured);
  }

  void publish(const OutgoingFrame& frame) {
    if (!frame.sparse) health_->show("last frame whole because", frame.reason);
    health_->count(frame.sparse ? "frames sparse" : "frames whole");
    outgoing_.publish(boost::make_shared<const OutgoingFrame>(frame));
    pictures_->show(frame);
  }

  std::string robot_;
  std::string exchange_topic_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<InputReport> inputs_;
  std::shared_ptr<RadioLinks> links_;   // null: links are not recovered
  std::unique_ptr<Redundancy> stage_;   // the worker's
  std::unique_ptr<Pictures> pictures_;  // the worker's
  ros::Publisher outgoing_;
  ros::Publisher prediction_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::RedundancyNodelet, nodelet::Nodelet)
