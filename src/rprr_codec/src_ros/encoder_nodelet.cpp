// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/BlockPreview.h>
#include <rprr_msgs/EncodedFrame.h>
#include <rprr_msgs/PoseUpdate.h>
#include <rprr_msgs/RadioState.h>
#include <rprr_msgs/Receipt.h>
#include <rprr_msgs/RelativePose.h>
#include <rprr_msgs/SamplePoints.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "encoder_options.hpp"
#include "rprr_codec/frame_codec.hpp"
#include "rprr_codec_ros/outgoing_message.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_radio/send_queue.hpp"
#include "rprr_radio_ros/radio_links.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/input_report.hpp"
#include "rprr_ros/live_options.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_ros/steady_now.hpp"
#include "rprr_ros/worker.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr std::size_t kLongestControl = 65536;  // [bytes] no message of an exchange comes near it
constexpr Duration kTellAgain = from_seconds(1.0);

std::vector<Stamp> to_stamps(const std::vector<ros::Time>& times) {
  std::vector<Stamp> stamps;
  for (const ros::Time& time : times) stamps.push_back(to_stamp(time));
  return stamps;
}

}  // namespace

/// A robot's way to the radio: /<robot>/rprr/outgoing to /<robot>/rprr/encoded, within the budget
/// and as the station's receipts allow (SendQueue). Parameters: config/encoder.yaml.
class EncoderNodelet : public nodelet::Nodelet {
 public:
  ~EncoderNodelet() override {
    timer_.stop();
    receipts_.shutdown();
    for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
    worker_.reset();  // its jobs use the members below
  }

 private:
  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    ros::NodeHandle& private_nh = getPrivateNodeHandle();
    const std::string wrong = read_parameters(private_nh, table_of(options_));
    robot_ = options_.robot;
    health_ = std::make_unique<Health>(nh, private_nh, "encoder", robot_);
    Result<FrameEncoder> encoder = FrameEncoder::create(options_.codec);
    if (!wrong.empty()) return health_->refuse_parameters(wrong);
    if (!encoder) return health_->refuse_parameters(encoder.reason());
    encoder_ = std::make_unique<FrameEncoder>(std::move(*encoder));
    options_.sending.robot = robot_;
    queue_ = std::make_unique<SendQueue>(options_.sending);
    const std::string prefix = "/" + robot_ + "/rprr/";
    const auto joined = [this](const ros::SingleSubscriberPublisher&) {
      const std::lock_guard<std::mutex> lock(mutex_);
      queue_->listener_joined();
    };
    publisher_ = nh.advertise<rprr_msgs::EncodedFrame>(prefix + "encoded", 16, joined);
    state_ = nh.advertise<rprr_msgs::RadioState>(prefix + "radio", 1, true);
    worker_ = std::make_unique<Worker>(2);  // jobs only look at the queue, so one may be dropped
    timer_ = nh.createWallTimer(tick(), &EncoderNodelet::on_timer, this);
    live_ = std::make_unique<LiveOptions>(private_nh, table_of(options_), *health_,
                                          [this] { return on_change(); });
    subscribe(nh, prefix);
    if (options_.link_recovery) {
      links_ = RadioLinks::look_after({receipts_.getTopic()});
    }
  }

  ros::WallDuration tick() const {
    return ros::WallDuration(options_.sending.bandwidth > 0.0 ? 0.01 : 0.05);
  }

  void subscribe(ros::NodeHandle& nh, const std::string& prefix) {
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    inputs_ = std::make_unique<InputReport>(nh, *health_);
    receipts_topic_ = nh.resolveName("/station/receipts");
    receipts_ = nh.subscribe(receipts_topic_, 20, &EncoderNodelet::on_receipt, this, hints);
    inputs_->expect(receipts_topic_, InputKind::kOnce, "receipts of the station",
                    "start the station, with the same master, and look whether it is in reach");
    subscribers_.push_back(
        nh.subscribe(prefix + "outgoing", 8, &EncoderNodelet::on_outgoing, this));
    inputs_->expect(subscribers_.back().getTopic(), InputKind::kSometimes, "frames to encode",
                    "start the nodelet rprr_redundancy/Redundancy of this robot");
    // What this robot's other nodelets put on the radio.
    count<rprr_msgs::BlockPreview>(nh, prefix + "preview");
    count<rprr_msgs::SamplePoints>(nh, prefix + "samples");
    count<rprr_msgs::PoseUpdate>(nh, prefix + "update");
    count<rprr_msgs::RelativePose>(nh, prefix + "relative_pose");
    count<rprr_msgs::BlockMask>(nh, prefix + "prediction");
  }

  template <typename Message>
  void count(ros::NodeHandle& nh, const std::string& topic) {
    subscribers_.push_back(
        nh.subscribe<Message>(topic, 20, [this](const boost::shared_ptr<const Message>& message) {
          const std::size_t bytes = ros::serialization::serializationLength(*message) + 4;
          const std::lock_guard<std::mutex> lock(mutex_);
          queue_->spent(std::min(bytes, kLongestControl), steady_now());
        }));
  }

  // Live options have changed. Empty, or why they cannot be.
  std::string on_change() {
    Result<FrameEncoder> encoder = FrameEncoder::create(options_.codec);
    if (!encoder) return encoder.reason();
    const std::lock_guard<std::mutex> lock(mutex_);
    next_encoder_ = std::make_unique<FrameEncoder>(std::move(*encoder));
    queue_->set_rate(options_.sending.bandwidth, options_.sending.frame_rate);
    timer_.setPeriod(tick());
    return {};
  }

  void on_outgoing(const OutgoingFrameConstPtr& outgoing) {
    if (!outgoing->frame) {
      return health_->error(
          "unusable", "a frame on /" + robot_ + "/rprr/outgoing was not sent: " + outgoing->reason);
    }
    QueuedFrame frame;
    frame.stamp = outgoing->frame->stamp;
    frame.frame_id = outgoing->frame->frame_id;
    frame.exchange = outgoing->exchange;
    frame.sparse = outgoing->sparse;
    frame.reference = outgoing->reference;
    frame.reference_stamp = outgoing->reference_stamp;
    std::size_t dropped = 0;
    bool narrow = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      frame.ticket = ++last_ticket_;
      waiting_[frame.ticket] = outgoing;
      const std::vector<QueuedFrame> gone = queue_->offer(std::move(frame), steady_now());
      for (const QueuedFrame& other : gone) waiting_.erase(other.ticket);
      dropped = gone.size();
      narrow = queue_->is_narrow();
    }
    if (dropped > 0) {
      health_->count("frames that gave way to newer ones", dropped);
      if (!narrow) {
        health_->warn("dropped", "encoding is slower than /" + robot_ +
                                     "/rprr/outgoing, or the station's receipts are slow: the "
                                     "oldest waiting frame was dropped; lower the frame rate, or "
                                     "raise ~queue_size if it comes in bursts");
      }
    }
    pump();
  }

  // How long none came is the queue's to say.
  void on_receipt(const rprr_msgs::ReceiptConstPtr& message) {
    inputs_->heard(receipts_topic_);
    health_->clear("no receipts");
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      queue_->receipt(message->robot, to_stamps(message->held), to_stamps(message->repeat),
                      to_stamp(message->last), steady_now());
    }
    pump();
  }

  void on_timer(const ros::WallTimerEvent&) { pump(); }

  void pump() {
    worker_->post([this] { work(); });
  }

  // From here on: the worker's thread.
  void work() {
    for (;;) {
      send_due();
      std::optional<EncodeOrder> order;
      OutgoingFrameConstPtr outgoing;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        order = queue_->next_to_encode(steady_now());
        if (next_encoder_) encoder_ = std::move(next_encoder_);
        if (order) outgoing = take_waiting(order->frame.ticket);
      }
      if (!order) break;
      encode(*order, *outgoing);
    }
    tell_state();
  }

  void send_due() {
    for (;;) {
      std::optional<SendOrder> order;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        order = queue_->next_to_send(steady_now());
      }
      if (!order) return;
      const auto out = boost::make_shared<rprr_msgs::EncodedFrame>();
      out->header.stamp = to_time(order->stamp);
      out->header.frame_id = order->frame_id;
      out->exchange = order->exchange;
      out->data = std::move(order->data);
      health_->count("bytes sent", out->data.size());
      publisher_.publish(out);
    }
  }

  // With the mutex held.
  OutgoingFrameConstPtr take_waiting(std::uint64_t ticket) {
    const auto found = waiting_.find(ticket);
    const OutgoingFrameConstPtr outgoing = found->second;
    waiting_.erase(found);
    return outgoing;
  }

  void encode(const EncodeOrder& order, const OutgoingFrame& outgoing) {
    EncodedFrame frame = frame_to_encode(outgoing, order.as_whole);
    if (order.as_whole) warn_of_whole(outgoing);
    const RgbdFrame& images = *outgoing.frame;
    const Result<bool> encoded =
        encoder_->encode_within(images.depth, images.bgr, frame, order.limit);
    if (!encoded) {
      const std::lock_guard<std::mutex> lock(mutex_);
      queue_->failed();
      health_->error("unusable",
                     "a frame on /" + robot_ + "/rprr/outgoing was not sent: " + encoded.reason());
      return;
    }
    EncodedSizes sizes;
    Bytes data = serialise(frame, &sizes);
    report(frame, sizes);
    const std::lock_guard<std::mutex> lock(mutex_);
    queue_->encoded(order, std::move(data), steady_now());
  }

  void warn_of_whole(const OutgoingFrame& outgoing) {
    health_->warn("reference not acknowledged",
                  "the station did not acknowledge the frame of '" + outgoing.reference +
                      "' that a frame refers to, so that goes out whole; look at the link between "
                      "that robot and the station, or raise ~receipt_timeout");
  }

  void report(const EncodedFrame& frame, const EncodedSizes& sizes) {
    health_->count(frame.sparse ? "sparse frames" : "whole frames");
    health_->show("last frame, bytes", std::to_string(sizes.total));
    health_->show("last frame, bytes of depth", std::to_string(sizes.depth));
    health_->show("last frame, bytes of colour", std::to_string(sizes.colour + sizes.base));
    health_->show("last frame, bytes of the base", std::to_string(sizes.base));
    health_->show("last frame, milliseconds", std::to_string(frame.report.ms_encode));
  }

  void tell_state() {
    LinkState link;
    double backlog = 0.0;
    bool ceased = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      link = queue_->link_state(steady_now());
      backlog = queue_->backlog(steady_now());
      ceased = queue_->receipts_ceased(steady_now());
      health_->show("frames repeated", std::to_string(queue_->repeated()));
    }
    if (ceased) {
      health_->warn("no receipts",
                    "the station sends no receipts on /station/receipts any more, so next to "
                    "nothing is sent to it: look at the station and at the radio");
    }
    const bool same = link.has_room == told_.has_room && link.references == told_.references;
    const SteadyTime now = steady_now();
    if (same && now - told_at_ < kTellAgain) return;
    told_at_ = now;
    told_ = link;
    rprr_msgs::RadioState state;
    state.ready = link.has_room ? 1 : 0;
    for (const Stamp stamp : link.references) state.references.push_back(to_time(stamp));
    state.frame_seconds = static_cast<float>(link.frame_seconds);
    state.backlog = static_cast<float>(backlog);
    state_.publish(state);
    health_->show("seconds of backlog", std::to_string(backlog));
    if (links_) show(links_->state(), *health_);
  }

  std::string robot_;
  EncoderOptions options_;  // the live ones change, in callbacks
  std::unique_ptr<Health> health_;
  std::mutex mutex_;  // guards queue_, waiting_, last_ticket_ and next_encoder_
  std::unique_ptr<SendQueue> queue_;
  std::map<std::uint64_t, OutgoingFrameConstPtr> waiting_;  // by ticket: what queue_ holds
  std::uint64_t last_ticket_ = 0;
  std::unique_ptr<FrameEncoder> next_encoder_;  // after a reconfiguration
  std::unique_ptr<FrameEncoder> encoder_;       // worker thread
  LinkState told_;
  SteadyTime told_at_;
  ros::Publisher publisher_;
  ros::Publisher state_;
  ros::Subscriber receipts_;
  std::vector<ros::Subscriber> subscribers_;
  std::shared_ptr<RadioLinks> links_;
  std::unique_ptr<InputReport> inputs_;
  std::string receipts_topic_;
  std::unique_ptr<LiveOptions> live_;
  ros::WallTimer timer_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::EncoderNodelet, nodelet::Nodelet)
