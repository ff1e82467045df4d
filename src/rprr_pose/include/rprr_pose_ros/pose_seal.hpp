// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/serialization.h>
#include <rprr_msgs/RelativePose.h>

#include <cstdint>

#include "rprr_wire/bytes.hpp"

namespace rprr {

/// What RelativePose::checksum is if the message came as it was sent. A pose has plain fields where
/// the other radio messages have sealed bytes, and a pose that is off by a bit is still a pose.
inline std::uint32_t checksum_of(rprr_msgs::RelativePose message) {
  message.header.seq = 0;  // the publisher's
  message.checksum = 0;
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return crc32(bytes);
}

}  // namespace rprr
