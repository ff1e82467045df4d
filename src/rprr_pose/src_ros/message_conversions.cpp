// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose_ros/message_conversions.hpp"

#include "rprr_pose_ros/pose_seal.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {

rprr_msgs::SamplePoints to_ros(const SamplesMessage& message) {
  rprr_msgs::SamplePoints out;
  out.header.stamp = to_time(message.stamp);
  out.header.frame_id = message.frame_id;
  out.receiver = message.receiver;
  out.exchange = message.exchange;
  out.data = message.data;
  return out;
}

rprr_msgs::PoseUpdate to_ros(const UpdateMessage& message) {
  rprr_msgs::PoseUpdate out;
  out.header.stamp = to_time(message.stamp);
  out.receiver = message.receiver;
  out.exchange = message.exchange;
  out.data = message.data;
  return out;
}

rprr_msgs::BlockPreview to_ros(const PreviewMessage& message) {
  rprr_msgs::BlockPreview out;
  out.header.stamp = to_time(message.stamp);
  out.header.frame_id = message.frame_id;
  out.receiver = message.receiver;
  out.exchange = message.exchange;
  out.data = message.data;
  return out;
}

rprr_msgs::RelativePose to_ros(const RelativePoseMessage& message) {
  rprr_msgs::RelativePose out;
  out.header.stamp = to_time(message.stamp);
  out.header.frame_id = message.frame_id;
  out.dependent_stamp = to_time(message.dependent_stamp);
  out.dependent = message.dependent;
  out.exchange = message.exchange;
  out.status = static_cast<std::uint8_t>(message.verdict.status);
  out.quantity = static_cast<std::uint8_t>(message.verdict.quantity);
  out.measured = message.verdict.measured;
  out.needed = message.verdict.needed;
  pose_to_fields(message.b_from_a, out.translation, out.rotation);
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) out.covariance[at++] = static_cast<float>(message.covariance(i, j));
  }
  out.iterations = message.iterations;
  out.inliers = message.inliers;
  out.residual = message.residual;
  out.dependent_age = message.dependent_age;
  out.reply_delay = message.reply_delay;
  out.reference_camera = message.reference_camera;
  out.bytes_spent = message.bytes_spent;
  out.checksum = checksum_of(out);
  return out;
}

SamplesMessage from_ros(const rprr_msgs::SamplePoints& message) {
  return {to_stamp(message.header.stamp), message.header.frame_id, message.receiver,
          message.exchange, message.data};
}

UpdateMessage from_ros(const rprr_msgs::PoseUpdate& message) {
  return {to_stamp(message.header.stamp), message.receiver, message.exchange, message.data};
}

PreviewMessage from_ros(const rprr_msgs::BlockPreview& message) {
  return {to_stamp(message.header.stamp), message.header.frame_id, message.receiver,
          message.exchange, message.data};
}

RelativePoseMessage from_ros(const rprr_msgs::RelativePose& message) {
  RelativePoseMessage out;
  out.stamp = to_stamp(message.header.stamp);
  out.frame_id = message.header.frame_id;
  out.dependent_stamp = to_stamp(message.dependent_stamp);
  out.dependent = message.dependent;
  out.exchange = message.exchange;
  out.verdict = {pose_status_from(message.status), pose_quantity_from(message.quantity),
                 message.measured, message.needed};
  out.b_from_a = pose_from_fields(message.translation, message.rotation);
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      out.covariance(i, j) = out.covariance(j, i) = static_cast<double>(message.covariance[at++]);
    }
  }
  out.iterations = message.iterations;
  out.inliers = message.inliers;
  out.residual = message.residual;
  out.dependent_age = message.dependent_age;
  out.reply_delay = message.reply_delay;
  out.reference_camera = message.reference_camera;
  out.bytes_spent = message.bytes_spent;
  return out;
}

}  // namespace rprr
