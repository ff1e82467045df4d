// SPDX-License-Identifier: BSD-3-Clause
#include "transport/subscribers.hpp"

#include <pluginlib/class_list_macros.hpp>

namespace rprr {
namespace {

std::size_t pixels(double megapixels) {
  return static_cast<std::size_t>(megapixels * 1e6);
}

}  // namespace

Result<sensor_msgs::Image> DhcmSubscriber::decode_with(
    const DhcmSubscriberConfig& config, const sensor_msgs::CompressedImage& message) {
  if (!decoder_ || pixels(config.max_megapixels) != max_pixels_) {
    max_pixels_ = pixels(config.max_megapixels);
    decoder_ = std::make_unique<DepthMessageDecoder>(max_pixels_);
  }
  return decoder_->decode(message);
}

Result<sensor_msgs::Image> PgfSubscriber::decode_with(const PgfSubscriberConfig& config,
                                                      const sensor_msgs::CompressedImage& message) {
  WorkerLimits limits;
  limits.seconds = config.time_limit;
  decoder_.set_limits(limits, pixels(config.max_megapixels));
  return decoder_.decode(message);
}

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::DhcmSubscriber, image_transport::SubscriberPlugin)
PLUGINLIB_EXPORT_CLASS(rprr::PgfSubscriber, image_transport::SubscriberPlugin)
