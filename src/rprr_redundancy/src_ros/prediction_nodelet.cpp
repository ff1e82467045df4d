// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/OutgoingFrame.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <memory>
#include <optional>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "accepted_pose.hpp"
#include "frame_matcher.hpp"
#include "outgoing_message.hpp"
#include "rprr_redundancy/decision.hpp"
#include "rprr_redundancy/recent_stamps.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/health.hpp"
#include "rprr_ros/parameters.hpp"
#include "rprr_ros/point_cloud.hpp"
#include "rprr_ros/worker.hpp"
#include "rprr_wire/mask_wire.hpp"
#include "rprr_wire/preview.hpp"

namespace rprr {
namespace {

sensor_msgs::PointCloud2 preview_cloud(const std_msgs::Header& header,
                                       const std::vector<PreviewPoint>& points) {
  sensor_msgs::PointCloud2 cloud = make_cloud(header, static_cast<std::uint32_t>(points.size()), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    set_point(cloud, i, points[i].position, points[i].bgr.val);
  }
  return cloud;
}

}  // namespace

/// The reference robot's side: hands its frames of exchanges to the encoder, once each, and tells
/// dependents which blocks to send (B_p, or with a preview the whole decision).
class PredictionNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    ros::NodeHandle& private_nh = getPrivateNodeHandle();
    const Parameters parameters(private_nh);
    robot_ = parameters.param<std::string>("robot", "");
    if (robot_.empty()) {
      NODELET_FATAL("~robot is not set: give the name of the robot that this runs on");
      return;
    }
    dependents_ = parameters.param("dependents", std::vector<std::string>());
    const int frames_held = std::max(parameters.param("frames_held", 30), 1);
    const double wait_for_frame = parameters.param("wait_for_frame", 0.5);

    health_ = std::make_unique<Health>(nh, private_nh, "prediction", robot_);
    const std::string prefix = "/" + robot_ + "/rprr/";
    outgoing_ = nh.advertise<rprr_msgs::OutgoingFrame>(prefix + "outgoing", 4);
    picture_ = nh.advertise<sensor_msgs::Image>(prefix + "decision", 2);
    points_ = nh.advertise<sensor_msgs::PointCloud2>(prefix + "preview_points", 2);
    prediction_ = nh.advertise<rprr_msgs::BlockMask>(prefix + "prediction", 4);
    worker_ = std::make_unique<Worker>(8);
    matcher_ = std::make_unique<FrameMatcher>(
        static_cast<std::size_t>(frames_held), wait_for_frame, robot_, *health_,
        [this](const auto& event, const auto& frame) { on_match(event, frame); },
        [this] { sent_ = RecentStamps(); });
    InputOptions input;
    input.max_stamp_difference = parameters.param("max_stamp_difference", 0.02);
    input.depth_unit = parameters.param("depth_unit", input.depth_unit);
    input.image_transport = parameters.param("image_transport", input.image_transport);
    images_ = std::make_unique<RgbdSubscriber>(
        nh, private_nh, robot_, input, *health_,
        [this](const RgbdFramePtr& frame) { matcher_->add_frame(frame); });
    events_ = nh.subscribe(prefix + "exchange", 8, &PredictionNodelet::on_event, this);
    timer_ = nh.createWallTimer(ros::WallDuration(0.1),
                                [this](const ros::WallTimerEvent&) { matcher_->tick(); });
  }

  void on_event(const rprr_msgs::ExchangeEventConstPtr& event) {
    const bool served = dependents_.empty() || std::find(dependents_.begin(), dependents_.end(),
                                                         event->peer) != dependents_.end();
    const bool sparse = event->action == rprr_msgs::ExchangeEvent::SEND_SPARSE;
    // Of an exchange in which this robot is itself the dependent, Validation takes care.
    if (!served || (sparse && event->pose.dependent == robot_)) return;
    matcher_->add_event(event);
  }

  void on_match(const rprr_msgs::ExchangeEventConstPtr& event, const RgbdFramePtr& frame) {
    // Also when a mask is asked for: it is worth nothing where the station has not the reference.
    if (sent_.insert(frame->stamp)) {
      const rprr_msgs::OutgoingFramePtr message = outgoing_message(*frame, event->exchange);
      message->ms_pose = event->ms_pose;
      outgoing_.publish(message);
      health_->count("reference frames sent");
    }
    if (event->action != rprr_msgs::ExchangeEvent::SEND_SPARSE) return;
    if (!worker_->post([this, event, frame] { predict(*event, *frame); })) {
      health_->warn("too slow",
                    "predictions are asked for faster than they are computed; lower "
                    "the rate of exchanges");
    }
  }

  void predict(const rprr_msgs::ExchangeEvent& event, const RgbdFrame& frame) {
    const Result<AcceptedPose> found = read_accepted_pose(event);
    if (!found) {
      return health_->error("exchange unusable", found.reason() + "; its frame will come whole");
    }
    const ros::WallTime start = ros::WallTime::now();
    const std::optional<BlockPreview> preview = preview_of(event);
    const BlockDecision decision =
        decider_.decide(frame.depth, frame.bgr, frame.camera, found->peer_camera, found->m_ab,
                        preview ? &*preview : nullptr);
    send(event, decision);
    health_->show("last prediction, ms",
                  std::to_string((ros::WallTime::now() - start).toSec() * 1e3));
    report(decision);
    if (decision.from_preview) show(event, found->peer_camera, *preview, decision);
  }

  void send(const rprr_msgs::ExchangeEvent& event, const BlockDecision& decision) {
    auto message = boost::make_shared<rprr_msgs::BlockMask>();
    message->header.stamp = event.pose.dependent_stamp;  // no frame_id: radio bytes
    message->receiver = event.peer;
    message->exchange = event.exchange;
    message->data = encode_mask_pair(decision.send);
    prediction_.publish(message);
    health_->count("predictions");
  }

  // For people, and only if somebody looks. Both are images of b, so they lie in b's frames.
  void show(const rprr_msgs::ExchangeEvent& event, const Camera& camera,
            const BlockPreview& preview, const BlockDecision& decision) {
    std_msgs::Header header;
    header.stamp = event.pose.dependent_stamp;
    if (picture_.getNumSubscribers() > 0) {
      header.frame_id = optical_frame(event.peer);
      picture_.publish(to_image(header, sensor_msgs::image_encodings::BGR8,
                                decision_picture(preview, decision.send)));
    }
    if (points_.getNumSubscribers() > 0) {
      header.frame_id = rebuilt_frame(event.peer);
      points_.publish(preview_cloud(header, preview_points(preview, camera)));
    }
  }

  std::optional<BlockPreview> preview_of(const rprr_msgs::ExchangeEvent& event) {
    if (event.peer_preview.empty()) return {};
    Result<BlockPreview> preview = decode_preview(event.peer_preview);
    if (preview) return std::move(*preview);
    health_->error("peer preview", "preview of '" + event.peer + "': " + preview.reason() +
                                       "; the blocks are decided without it");
    return {};
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

  // In the order in which they need each other: what is below is destroyed first.
  std::string robot_;
  std::vector<std::string> dependents_;
  std::unique_ptr<Health> health_;
  ros::Publisher outgoing_;
  ros::Publisher prediction_;
  ros::Publisher picture_;
  ros::Publisher points_;
  RecentStamps sent_;
  Decider decider_;  // the worker's
  std::unique_ptr<Worker> worker_;
  std::unique_ptr<FrameMatcher> matcher_;
  std::unique_ptr<RgbdSubscriber> images_;
  ros::Subscriber events_;
  ros::WallTimer timer_;
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::PredictionNodelet, nodelet::Nodelet)
