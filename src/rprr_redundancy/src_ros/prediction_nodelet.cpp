// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <rprr_msgs/BlockMask.h>
#include <rprr_msgs/ExchangeEvent.h>
#include <rprr_msgs/OutgoingFrame.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "frame_matcher.hpp"
#include "outgoing_message.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry_ros/conversions.hpp"
#include "rprr_geometry_ros/health.hpp"
#include "rprr_geometry_ros/worker.hpp"
#include "rprr_redundancy/prediction.hpp"
#include "rprr_redundancy/recent_stamps.hpp"

namespace rprr {

/// The reference robot's side: hands its frames of exchanges to the encoder, once each, and tells
/// dependents which blocks to send (B_p).
class PredictionNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    ros::NodeHandle& private_nh = getPrivateNodeHandle();
    robot_ = private_nh.param<std::string>("robot", "");
    if (robot_.empty()) {
      NODELET_FATAL("~robot is not set: give the name of the robot that this runs on");
      return;
    }
    dependents_ = private_nh.param("dependents", std::vector<std::string>());
    const int frames_held = std::max(private_nh.param("frames_held", 30), 1);
    const double wait_for_frame = private_nh.param("wait_for_frame", 0.5);

    health_ = std::make_unique<Health>(nh, private_nh, "prediction", robot_);
    const std::string prefix = "/" + robot_ + "/rprr/";
    outgoing_ = nh.advertise<rprr_msgs::OutgoingFrame>(prefix + "outgoing", 4);
    prediction_ = nh.advertise<rprr_msgs::BlockMask>(prefix + "prediction", 4);
    worker_ = std::make_unique<Worker>(8);
    matcher_ = std::make_unique<FrameMatcher>(
        static_cast<std::size_t>(frames_held), wait_for_frame,
        [this](const auto& event, const auto& frame) { on_match(event, frame); },
        [this](const auto& event) { on_miss(*event); });
    images_ = std::make_unique<RgbdSubscriber>(
        nh, private_nh, robot_, *health_,
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

  void on_miss(const rprr_msgs::ExchangeEvent& event) {
    health_->error("frame not held",
                   "the exchange with '" + event.peer +
                       "' speaks of a frame that is not held (any more): its stamp must be that of "
                       "an image on /" +
                       robot_ +
                       "/camera/rgb/image_rect_color; raise ~frames_held if exchanges are slow");
  }

  void predict(const rprr_msgs::ExchangeEvent& event, const RgbdFrame& frame) {
    if (event.pose.status != rprr_msgs::RelativePose::ACCEPTED) {
      return health_->error("no pose", "asked for a prediction without an accepted pose");
    }
    ByteReader reader{ByteView(event.peer_camera)};
    const Result<Camera> camera = get_camera(reader);
    if (!camera) {
      return health_->error("peer camera", "camera of '" + event.peer + "': " + camera.reason() +
                                               "; its frame will come whole");
    }
    const Pose m_ab = pose_from_fields(event.pose.translation, event.pose.rotation);
    if (!is_rigid(m_ab)) {
      return health_->error("pose unusable", "the pose of the exchange with '" + event.peer +
                                                 "' is no rigid motion; its frame will come whole");
    }
    const ros::WallTime start = ros::WallTime::now();
    const BlockMask predicted = predictor_.predict(frame.depth, frame.camera, *camera, m_ab);
    auto message = boost::make_shared<rprr_msgs::BlockMask>();
    message->header.stamp = event.pose.dependent_stamp;  // no frame_id: radio bytes
    message->receiver = event.peer;
    message->exchange = event.exchange;
    message->data = encode_mask(predicted);
    prediction_.publish(message);
    health_->count("predictions");
    health_->show("last prediction, blocks", std::to_string(predicted.count()));
    health_->show("last prediction, ms",
                  std::to_string((ros::WallTime::now() - start).toSec() * 1e3));
  }

  // In the order in which they need each other: what is below is destroyed first.
  std::string robot_;
  std::vector<std::string> dependents_;
  std::unique_ptr<Health> health_;
  ros::Publisher outgoing_;
  ros::Publisher prediction_;
  RecentStamps sent_;
  Predictor predictor_;  // the worker's
  std::unique_ptr<Worker> worker_;
  std::unique_ptr<FrameMatcher> matcher_;
  std::unique_ptr<RgbdSubscriber> images_;
  ros::Subscriber events_;
  ros::WallTimer timer_;
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::PredictionNodelet, nodelet::Nodelet)
