// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <image_transport/simple_subscriber_plugin.h>
#include <sensor_msgs/CompressedImage.h>

#include <boost/make_shared.hpp>
#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "transport/colour_message.hpp"
#include "transport/depth_message.hpp"
#include "transport/live_settings.hpp"
#include "transport/transport_settings.hpp"

namespace rprr {

/// What the two transports share: settings under ~<transport>/<topic>, and no message that does
/// more harm than a word now and then.
template <typename Settings>
class TransportSubscriber
    : public image_transport::SimpleSubscriberPlugin<sensor_msgs::CompressedImage> {
 protected:
  using Base = image_transport::SimpleSubscriberPlugin<sensor_msgs::CompressedImage>;

  void subscribeImpl(ros::NodeHandle& nh, const std::string& base_topic, std::uint32_t queue_size,
                     const Callback& callback, const ros::VoidPtr& tracked_object,
                     const image_transport::TransportHints& hints) override {
    const std::string topic = nh.resolveName(base_topic);
    settings_.start(ros::NodeHandle(ros::NodeHandle(hints.getParameterNH(), getTransportName()),
                                    topic.substr(topic.find_first_not_of('/'))));
    Base::subscribeImpl(nh, base_topic, queue_size, callback, tracked_object, hints);
  }

  void internalCallback(const sensor_msgs::CompressedImageConstPtr& message,
                        const Callback& user_cb) override {
    const sensor_msgs::ImageConstPtr image = image_of(*message);
    if (image) user_cb(image);  // not guarded: what it throws is its own affair
  }

  virtual Result<sensor_msgs::Image> decode_with(const Settings& settings,
                                                 const sensor_msgs::CompressedImage& message) = 0;

 private:
  sensor_msgs::ImageConstPtr image_of(const sensor_msgs::CompressedImage& message) {
    std::string reason;
    try {
      const std::lock_guard<std::mutex> lock(mutex_);
      Result<sensor_msgs::Image> image = decode_with(settings_.get(), message);
      if (image) return boost::make_shared<sensor_msgs::Image>(std::move(*image));
      reason = image.reason();
    } catch (const std::exception& error) {  // out of memory
      reason = error.what();
    }
    ROS_WARN_STREAM_THROTTLE(5.0, getTopic() << ": an image was dropped: " << reason);
    return nullptr;
  }

  LiveSettings<Settings> settings_;
  std::mutex mutex_;
};

class DhcmSubscriber : public TransportSubscriber<DhcmReceiving> {
 public:
  std::string getTransportName() const override { return "dhcm"; }

 protected:
  Result<sensor_msgs::Image> decode_with(const DhcmReceiving& settings,
                                         const sensor_msgs::CompressedImage& message) override;

 private:
  std::size_t max_pixels_ = 0;
  std::unique_ptr<DepthMessageDecoder> decoder_;
};

class PgfSubscriber : public TransportSubscriber<PgfReceiving> {
 public:
  std::string getTransportName() const override { return "pgf"; }

 protected:
  Result<sensor_msgs::Image> decode_with(const PgfReceiving& settings,
                                         const sensor_msgs::CompressedImage& message) override;

 private:
  ColourMessageDecoder decoder_;
};

}  // namespace rprr
