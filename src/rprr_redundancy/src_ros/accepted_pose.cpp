// SPDX-License-Identifier: BSD-3-Clause
#include "accepted_pose.hpp"

#include "rprr_ros/conversions.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {

Result<AcceptedPose> read_accepted_pose(const rprr_msgs::ExchangeEvent& event) {
  const std::string exchange = "the exchange with '" + event.peer + "' ";
  if (event.pose.status != rprr_msgs::RelativePose::ACCEPTED) {
    return Error{exchange + "ended without an accepted pose"};
  }
  ByteReader reader{ByteView(event.peer_camera)};
  const Result<Camera> camera = get_camera(reader);
  if (!camera) return Error{exchange + "gives no camera: " + camera.reason()};
  const Pose m_ab = pose_from_fields(event.pose.translation, event.pose.rotation);
  if (!is_rigid(m_ab)) return Error{exchange + "gives a pose that is no rigid motion"};
  return AcceptedPose{m_ab, *camera};
}

}  // namespace rprr
