// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <rprr_msgs/EncodedFrame.h>
#include <rprr_msgs/OutgoingFrame.h>

#include <algorithm>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "codec_options.hpp"
#include "outgoing_conversion.hpp"
#include "rprr_codec/frame_codec.hpp"
#include "rprr_geometry_ros/conversions.hpp"
#include "rprr_geometry_ros/health.hpp"
#include "rprr_geometry_ros/worker.hpp"

namespace rprr {

/// /<robot>/rprr/outgoing to /<robot>/rprr/encoded. Parameters: config/encoder.yaml.
class EncoderNodelet : public nodelet::Nodelet {
 public:
  ~EncoderNodelet() override {
    subscriber_.shutdown();
    worker_.reset();  // its job uses the members below
  }

 private:
  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    ros::NodeHandle& private_nh = getPrivateNodeHandle();
    robot_ = private_nh.param<std::string>("robot", "eyebug_a");
    depth_unit_ = private_nh.param("depth_unit", 0.0002);
    const int queue_size = std::max(1, private_nh.param("queue_size", 5));
    health_ = std::make_unique<Health>(nh, private_nh, "encoder", robot_);
    if (!make_encoder(private_nh)) return;

    publisher_ = nh.advertise<rprr_msgs::EncodedFrame>("/" + robot_ + "/rprr/encoded",
                                                       static_cast<std::uint32_t>(queue_size));
    worker_ = std::make_unique<Worker>(static_cast<std::size_t>(queue_size));
    subscriber_ =
        nh.subscribe("/" + robot_ + "/rprr/outgoing", static_cast<std::uint32_t>(queue_size),
                     &EncoderNodelet::on_outgoing, this);
  }

  bool make_encoder(const ros::NodeHandle& private_nh) {
    const Result<FrameCodecOptions> options = read_codec_options(private_nh);
    Result<FrameEncoder> encoder =
        options ? FrameEncoder::create(*options) : Result<FrameEncoder>(Error{options.reason()});
    std::string problem = encoder ? std::string() : encoder.reason();
    if (!(depth_unit_ > 0.0)) problem = "~depth_unit must be above 0 (metres per count)";
    if (!problem.empty()) {
      NODELET_FATAL_STREAM(problem << "; nothing is encoded until this is mended and restarted");
      health_->error("parameters", problem);
      return false;
    }
    encoder_ = std::make_unique<FrameEncoder>(std::move(*encoder));
    return true;
  }

  void on_outgoing(const rprr_msgs::OutgoingFrameConstPtr& message) {
    if (!worker_->post([this, message] { encode(*message); })) {
      health_->warn("dropped",
                    "encoding is slower than " + subscriber_.getTopic() +
                        ": the oldest waiting frame was dropped; lower the frame rate, or raise "
                        "~queue_size if it comes in bursts");
    }
  }

  void encode(const rprr_msgs::OutgoingFrame& message) {
    Result<OutgoingImages> images = images_of(message, depth_unit_);
    Result<bool> encoded = images ? encoder_->encode(images->depth, images->bgr, images->frame)
                                  : Result<bool>(Error{images.reason()});
    if (!encoded) {
      health_->error("unusable",
                     "a frame on " + subscriber_.getTopic() + " was not sent: " + encoded.reason());
      return;
    }
    const auto out = boost::make_shared<rprr_msgs::EncodedFrame>();
    out->header.stamp = message.header.stamp;
    out->header.frame_id = clean_frame(message.header.frame_id);
    out->exchange = message.exchange;
    EncodedSizes sizes;
    out->data = serialise(images->frame, &sizes);
    publisher_.publish(out);
    report(images->frame, sizes);
  }

  void report(const EncodedFrame& frame, const EncodedSizes& sizes) {
    health_->count(frame.sparse ? "sparse frames" : "whole frames");
    health_->count("bytes sent", sizes.total);
    health_->show("last frame, bytes", std::to_string(sizes.total));
    health_->show("last frame, bytes of depth", std::to_string(sizes.depth));
    health_->show("last frame, bytes of colour", std::to_string(sizes.colour + sizes.base));
    health_->show("last frame, bytes of the base", std::to_string(sizes.base));
    health_->show("last frame, milliseconds", std::to_string(frame.report.ms_encode));
  }

  std::string robot_;
  double depth_unit_ = 0.0;
  std::unique_ptr<Health> health_;
  std::unique_ptr<FrameEncoder> encoder_;  // the worker's thread only
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::EncoderNodelet, nodelet::Nodelet)
