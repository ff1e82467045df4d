// SPDX-License-Identifier: BSD-3-Clause
#include "transport/publishers.hpp"

#include <pluginlib/class_list_macros.hpp>

namespace rprr {

Result<sensor_msgs::CompressedImage> DhcmPublisher::encode_with(
    DepthMessageEncoder& encoder, const DhcmPublisherConfig& config,
    const sensor_msgs::Image& image) const {
  const Result<DhcmMode> mode = dhcm_mode_from_name(config.mode);
  if (!mode) return Error{mode.reason()};
  return encoder.encode(image, *mode, config.step);
}

std::string DhcmPublisher::advice() const {
  return "(dhcm is for depth, 16UC1 or 32FC1; colour goes by pgf)";
}

Result<sensor_msgs::CompressedImage> PgfPublisher::encode_with(
    ColourMessageEncoder& encoder, const PgfPublisherConfig& config,
    const sensor_msgs::Image& image) const {
  return encoder.encode(image, config.quality);
}

std::string PgfPublisher::advice() const {
  return "(pgf is for 8-bit colour; depth goes by dhcm)";
}

}  // namespace rprr

PLUGINLIB_EXPORT_CLASS(rprr::DhcmPublisher, image_transport::PublisherPlugin)
PLUGINLIB_EXPORT_CLASS(rprr::PgfPublisher, image_transport::PublisherPlugin)
