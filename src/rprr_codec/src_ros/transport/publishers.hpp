// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <image_transport/simple_publisher_plugin.h>
#include <sensor_msgs/CompressedImage.h>

#include <mutex>
#include <string>

#include "transport/colour_message.hpp"
#include "transport/depth_message.hpp"
#include "transport/live_settings.hpp"
#include "transport/transport_settings.hpp"

namespace rprr {

/// What the two transports share: settings under <topic>/<transport>, one encoder for all threads,
/// and a word now and then about images that cannot be sent.
template <typename Encoder, typename Settings>
class TransportPublisher
    : public image_transport::SimplePublisherPlugin<sensor_msgs::CompressedImage> {
 protected:
  using Base = image_transport::SimplePublisherPlugin<sensor_msgs::CompressedImage>;

  void advertiseImpl(ros::NodeHandle& nh, const std::string& base_topic, std::uint32_t queue_size,
                     const image_transport::SubscriberStatusCallback& user_connect_cb,
                     const image_transport::SubscriberStatusCallback& user_disconnect_cb,
                     const ros::VoidPtr& tracked_object, bool latch) override {
    Base::advertiseImpl(nh, base_topic, queue_size, user_connect_cb, user_disconnect_cb,
                        tracked_object, latch);
    settings_.start(this->nh());
  }

  void publish(const sensor_msgs::Image& image, const PublishFn& publish_fn) const override {
    const Result<sensor_msgs::CompressedImage> message = encode(image);
    if (message) {
      publish_fn(*message);
    } else {
      ROS_WARN_STREAM_THROTTLE(
          30.0, getTopic() << ": an image was not sent: " << message.reason() << " " << advice());
    }
  }

  virtual Result<sensor_msgs::CompressedImage> encode_with(
      Encoder& encoder, const Settings& settings, const sensor_msgs::Image& image) const = 0;
  virtual std::string advice() const = 0;

 private:
  Result<sensor_msgs::CompressedImage> encode(const sensor_msgs::Image& image) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return encode_with(encoder_, settings_.get(), image);
  }

  LiveSettings<Settings> settings_;
  mutable std::mutex mutex_;
  mutable Encoder encoder_;  // image_transport publishes through const methods
};

class DhcmPublisher : public TransportPublisher<DepthMessageEncoder, DhcmSending> {
 public:
  std::string getTransportName() const override { return "dhcm"; }

 protected:
  Result<sensor_msgs::CompressedImage> encode_with(DepthMessageEncoder& encoder,
                                                   const DhcmSending& settings,
                                                   const sensor_msgs::Image& image) const override;
  std::string advice() const override;
};

class PgfPublisher : public TransportPublisher<ColourMessageEncoder, PgfSending> {
 public:
  std::string getTransportName() const override { return "pgf"; }

 protected:
  Result<sensor_msgs::CompressedImage> encode_with(ColourMessageEncoder& encoder,
                                                   const PgfSending& settings,
                                                   const sensor_msgs::Image& image) const override;
  std::string advice() const override;
};

}  // namespace rprr
