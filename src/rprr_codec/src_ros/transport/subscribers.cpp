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
    const DhcmReceiving& settings, const sensor_msgs::CompressedImage& message) {
  if (!decoder_ || pixels(settings.max_megapixels) != max_pixels_) {
    max_pixels_ = pixels(settings.max_megapixels);
    decoder_ = std::make_unique<DepthMessageDecoder>(max_pixels_);
  }
  return decoder_->decode(message);
}

Result<sensor_msgs::Image> PgfSubscriber::decode_with(const PgfReceiving& settings,
                                                      const sensor_msgs::CompressedImage& message) {
  WorkerLimits limits;
  limits.seconds = settings.time_limit;
  decoder_.set_limits(limits, pixels(settings.max_megapixels));
  return decoder_.decode(message);
}

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::DhcmSubscriber, image_transport::SubscriberPlugin)
PLUGINLIB_EXPORT_CLASS(rprr::PgfSubscriber, image_transport::SubscriberPlugin)
