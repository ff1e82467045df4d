// SPDX-License-Identifier: BSD-3-Clause
#include "transport/publishers.hpp"

#include <pluginlib/class_list_macros.hpp>

namespace rprr {

Result<sensor_msgs::CompressedImage> DhcmPublisher::encode_with(
    DepthMessageEncoder& encoder, const DhcmSending& settings,
    const sensor_msgs::Image& image) const {
  return encoder.encode(image, settings.mode, settings.step);
}

std::string DhcmPublisher::advice() const {
  return "(dhcm is for depth, 16UC1 or 32FC1; colour goes by pgf)";
}

Result<sensor_msgs::CompressedImage> PgfPublisher::encode_with(
    ColourMessageEncoder& encoder, const PgfSending& settings,
    const sensor_msgs::Image& image) const {
  return encoder.encode(image, settings.quality);
}

std::string PgfPublisher::advice() const {
  return "(pgf is for 8-bit colour; depth goes by dhcm)";
}

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::DhcmPublisher, image_transport::PublisherPlugin)
PLUGINLIB_EXPORT_CLASS(rprr::PgfPublisher, image_transport::PublisherPlugin)
