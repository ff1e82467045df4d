// SPDX-License-Identifier: BSD-3-Clause
#include "outgoing_message.hpp"

#include <boost/make_shared.hpp>

#include "rprr_ros/conversions.hpp"

namespace rprr {

rprr_msgs::OutgoingFramePtr outgoing_message(const RgbdFrame& frame, std::uint32_t exchange) {
  auto message = boost::make_shared<rprr_msgs::OutgoingFrame>();
  message->header = frame.header;
  message->exchange = exchange;
  message->sparse = false;
  pose_to_fields(Pose::Identity(), message->translation, message->rotation);
  message->camera_info = info_from_camera(frame.camera, frame.header);
  message->rgb = *frame.rgb_message;
  message->depth = *frame.depth_message;
  return message;
}

}  // namespace rprr
