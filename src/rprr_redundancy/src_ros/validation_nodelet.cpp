// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/OutgoingFrame.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "accepted_pose.hpp"
#include "frame_matcher.hpp"
#include "outgoing_message.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_radio_ros/radio_links.hpp"
#include "rprr_redundancy/outgoing.hpp"
#include "rprr_redundancy/sparse_image.hpp"
#include "rprr_redundancy/validation.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_ros/worker.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {

/// The dependent robot's side, for one peer: adds what it alone can know (B_v) to what the
/// reference asks for (B_p) and hands its frames to the encoder.
class ValidationNodelet : public nodelet::Nodelet {
 private:
  struct Held {
    rprr_msgs::ExchangeEventConstPtr event;
    RgbdFramePtr frame;
    double ms_validate = 0.0;
  };

  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    ros::NodeHandle& private_nh = getPrivateNodeHandle();
    const Parameters parameters(private_nh);
    robot_ = parameters.param<std::string>("robot", "");
    peer_ = parameters.param<std::string>("peer", "");
    if (robot_.empty() || peer_.empty() || robot_ == peer_) {
      NODELET_FATAL("~robot and ~peer must name this robot and the one whose frames it refers to");
      return;
    }
    OutgoingOptions options;
    options.prediction_timeout = from_seconds(parameters.param("prediction_timeout", 1.0));
    outgoing_ = std::make_unique<Outgoing>(robot_, options);
    validator_ = Validator({std::max(parameters.param("validation_min_pixels", 1), 1)});
    const int frames_held = std::max(parameters.param("frames_held", 30), 1);
    const double wait_for_frame = parameters.param("wait_for_frame", 0.5);

    health_ = std::make_unique<Health>(nh, private_nh, "validation", robot_);
    advertise(nh);
    worker_ = std::make_unique<Worker>(8);
    matcher_ = std::make_unique<FrameMatcher>(
        static_cast<std::size_t>(frames_held), wait_for_frame, robot_, *health_,
        [this](const auto& event, const auto& frame) { on_match(event, frame); },
        [this] { on_restart(); });
    InputOptions input;
    input.max_stamp_difference = parameters.param("max_stamp_difference", 0.02);
    input.depth_unit = parameters.param("depth_unit", input.depth_unit);
    input.image_transport = parameters.param("image_transport", input.image_transport);
    images_ = std::make_unique<RgbdSubscriber>(
        nh, private_nh, robot_, input, *health_,
        [this](const RgbdFramePtr& frame) { matcher_->add_frame(frame); });
    events_ = nh.subscribe("/" + robot_ + "/rprr/exchange", 8, &ValidationNodelet::on_event, this);
    predictions_ =
        nh.subscribe("/" + peer_ + "/rprr/prediction", 8, &ValidationNodelet::on_prediction, this);
    timer_ = nh.createWallTimer(ros::WallDuration(0.02), &ValidationNodelet::on_timer, this);
  }

  void advertise(ros::NodeHandle& nh) {
    const std::string prefix = "/" + robot_ + "/rprr/";
    outgoing_publisher_ = nh.advertise<rprr_msgs::OutgoingFrame>(prefix + "outgoing", 4);
    validation_publisher_ = nh.advertise<rprr_msgs::BlockMask>(prefix + "validation", 2);
    mask_publisher_ = nh.advertise<sensor_msgs::Image>(prefix + "mask", 2);
    rgb_publisher_ = nh.advertise<sensor_msgs::Image>(prefix + "sparse/rgb", 2);
    depth_publisher_ = nh.advertise<sensor_msgs::Image>(prefix + "sparse/depth", 2);
  }

  static Stamp now() { return static_cast<Stamp>(ros::SteadyTime::now().toNSec()); }

  void on_event(const rprr_msgs::ExchangeEventConstPtr& event) {
    const bool sparse = event->action == rprr_msgs::ExchangeEvent::SEND_SPARSE;
    const bool ours = event->peer == peer_ || (event->peer.empty() && !sparse);
    // Of an exchange in which this robot is the reference, Prediction takes care.
    const bool reference = sparse && event->pose.dependent == peer_;
    if (ours && !reference) matcher_->add_event(event);
  }

  void on_match(const rprr_msgs::ExchangeEventConstPtr& event, const RgbdFramePtr& frame) {
    if (!worker_->post([this, event, frame] { decide(event, frame); })) {
      health_->warn("too slow", "exchanges end faster than frames are handled; lower their rate");
    }
  }

  void on_restart() {
    const std::lock_guard<std::mutex> lock(mutex_);
    outgoing_->restart();
    held_.clear();
  }

  // The worker's thread.
  void decide(const rprr_msgs::ExchangeEventConstPtr& event, const RgbdFramePtr& frame) {
    Held held{event, frame, 0.0};
    std::string reason = event->reason;
    BlockMask validated;
    if (event->action == rprr_msgs::ExchangeEvent::SEND_SPARSE) {
      Result<BlockMask> blocks = validate(held);
      if (blocks) {
        validated = *blocks;
      } else {
        reason = blocks.reason();
        health_->error("exchange unusable", reason + "; the frame goes out whole");
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!outgoing_->waits(frame->stamp)) held_[frame->stamp] = held;
    publish(validated.empty()
                ? outgoing_->whole(frame->stamp, event->exchange, reason)
                : outgoing_->accepted(frame->stamp, event->exchange, validated, now()));
    if (!outgoing_->waits(frame->stamp)) held_.erase(frame->stamp);
  }

  Result<BlockMask> validate(Held& held) {
    const Result<AcceptedPose> found = read_accepted_pose(*held.event);
    if (!found) return Error{found.reason()};
    const ros::WallTime start = ros::WallTime::now();
    BlockMask blocks =
        validator_.validate(held.frame->depth, held.frame->camera, found->peer_camera, found->m_ab);
    held.ms_validate = (ros::WallTime::now() - start).toSec() * 1e3;
    if (validation_publisher_.getNumSubscribers() > 0) {
      rprr_msgs::BlockMask message;
      message.header = held.frame->header;
      message.exchange = held.event->exchange;
      message.data = encode_mask(blocks);
      validation_publisher_.publish(message);
    }
    return blocks;
  }

  void on_prediction(const rprr_msgs::BlockMaskConstPtr& message) {
    PredictionMessage prediction;
    prediction.receiver = message->receiver;
    prediction.exchange = message->exchange;
    prediction.stamp = to_stamp(message->header.stamp);
    prediction.mask = ByteView(message->data);
    prediction.frame_id_length = message->header.frame_id.size();
    const std::lock_guard<std::mutex> lock(mutex_);
    publish(outgoing_->prediction(prediction, now()));
  }

  void on_timer(const ros::WallTimerEvent&) {
    matcher_->tick();
    const std::lock_guard<std::mutex> lock(mutex_);
    publish(outgoing_->tick(now()));
  }

  // With the mutex held.
  void publish(const std::vector<OutgoingDecision>& decisions) {
    for (const OutgoingDecision& decision : decisions) {
      const auto held = held_.find(decision.stamp);
      if (held == held_.end()) continue;
      publish(decision, held->second);
      held_.erase(held);
    }
  }

  void publish(const OutgoingDecision& decision, const Held& held) {
    if (!decision.sparse) health_->show("last frame whole because", decision.reason);
    health_->count(decision.sparse ? "frames sparse" : "frames whole");
    outgoing_publisher_.publish(message_of(decision, held));
    const BlockGrid grid(held.frame->camera.width, held.frame->camera.height);
    const BlockMask all(grid, true);
    show(*held.frame, decision.sparse ? decision.mask : all,
         decision.sparse ? decision.depth_mask : all);
  }

  rprr_msgs::OutgoingFramePtr message_of(const OutgoingDecision& decision, const Held& held) const {
    rprr_msgs::OutgoingFramePtr message = outgoing_message(*held.frame, decision.exchange);
    message->mask_bytes = static_cast<std::uint32_t>(decision.message_bytes);
    message->exchange_bytes = held.event->exchange_bytes + message->mask_bytes;
    message->ms_pose = held.event->ms_pose;
    message->ms_validate = static_cast<float>(held.ms_validate);
    if (!decision.sparse) return message;
    const rprr_msgs::RelativePose& pose = held.event->pose;
    message->sparse = true;
    message->reference = peer_;
    message->reference_stamp = pose.header.stamp;
    message->translation = pose.translation;
    message->rotation = pose.rotation;
    message->mask = encode_mask(decision.mask);
    message->depth_mask = encode_mask(decision.depth_mask);
    message->blocks_predicted = static_cast<std::uint32_t>(decision.blocks_predicted);
    message->blocks_validated = static_cast<std::uint32_t>(decision.blocks_validated);
    return message;
  }

  void show(const RgbdFrame& frame, const BlockMask& mask, const BlockMask& depth_mask) {
    namespace encodings = sensor_msgs::image_encodings;
    if (mask_publisher_.getNumSubscribers() > 0) {
      mask_publisher_.publish(to_image(frame.header, encodings::MONO8, mask.to_image()));
    }
    if (rgb_publisher_.getNumSubscribers() > 0) {
      if (const Result<cv::Mat> rgb = keep_blocks(frame.bgr, mask)) {
        rgb_publisher_.publish(to_image(frame.header, encodings::BGR8, *rgb));
      }
    }
    if (depth_publisher_.getNumSubscribers() > 0) {
      if (const Result<cv::Mat> counts = keep_blocks(frame.depth.counts, depth_mask)) {
        depth_publisher_.publish(to_depth_image(frame.header, {*counts, frame.depth.unit}));
      }
    }
  }

  // In the order in which they need each other: what is below is destroyed first.
  std::string robot_;
  std::string peer_;
  std::unique_ptr<Health> health_;
  std::shared_ptr<RadioLinks> links_ = RadioLinks::of_this_process();
  ros::Publisher outgoing_publisher_;
  ros::Publisher validation_publisher_;
  ros::Publisher mask_publisher_;
  ros::Publisher rgb_publisher_;
  ros::Publisher depth_publisher_;
  std::mutex mutex_;  // of the next two
  std::unique_ptr<Outgoing> outgoing_;
  std::map<Stamp, Held> held_;  // frames that wait, as outgoing_ bounds them
  Validator validator_;         // the worker's
  std::unique_ptr<Worker> worker_;
  std::unique_ptr<FrameMatcher> matcher_;
  std::unique_ptr<RgbdSubscriber> images_;
  ros::Subscriber events_;
  ros::Subscriber predictions_;
  ros::WallTimer timer_;
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::ValidationNodelet, nodelet::Nodelet)
