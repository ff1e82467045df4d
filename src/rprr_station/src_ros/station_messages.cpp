// SPDX-License-Identifier: BSD-3-Clause
#include "station_messages.hpp"

#include <sensor_msgs/image_encodings.h>

#include <limits>

#include "rprr_ros/conversions.hpp"
#include "rprr_ros/point_cloud.hpp"
#include "rprr_station/frustum.hpp"

#include "rprr_ros/conversions.hpp"

namespace rprr {
std_msgs::Header header_of(const RebuiltFrame& frame) {
  std_msgs::Header header;
  header.stamp = to_time(frame.stamp);
  header.frame_id = frame.sparse ? rebuilt_frame(frame.robot) : clean_frame(frame.frame_id);
  if (header.frame_id.empty()) header.frame_id = optical_frame(frame.robot);
  return header;
}

sensor_msgs::Image depth_message(const RebuiltFrame& frame, const std_msgs::Header& header,
                                 DepthEncoding encoding) {
  namespace encodings = sensor_msgs::image_encodings;
  switch (encoding) {
    case DepthEncoding::kMillimetres:
      return to_image(header, encodings::TYPE_16UC1, to_millimetre_image(frame.depth));
    case DepthEncoding::kMetres:
      return to_image(header, encodings::TYPE_32FC1, to_float_image(frame.depth));
    case DepthEncoding::kAuto:
      break;
  }
  return to_depth_image(header, frame.depth);
}

sensor_msgs::PointCloud2 cloud_message(const RebuiltFrame& frame, const std_msgs::Header& header) {
  sensor_msgs::PointCloud2 cloud =
      make_cloud(header, static_cast<std::uint32_t>(frame.camera.width),
                 static_cast<std::uint32_t>(frame.camera.height));
  const Eigen::Vector3f none = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  std::size_t index = 0;
  for (int v = 0; v < frame.camera.height; ++v) {
    const auto* colour = frame.bgr.ptr<std::uint8_t>(v);
    for (int u = 0; u < frame.camera.width; ++u, colour += 3, ++index) {
      const double z = frame.depth.metres(u, v);
      const bool known = z > 0;
      set_point(cloud, index, known ? frame.camera.unproject(u, v, z).cast<float>() : none, colour);
    }
  }
  return cloud;
}

sensor_msgs::PointCloud2 scene_message(const Scene& scene) {
  std_msgs::Header header;
  header.stamp = to_time(scene.stamp);
  header.frame_id = clean_frame(scene.frame_id);
  if (header.frame_id.empty()) header.frame_id = optical_frame(scene.robot);
  sensor_msgs::PointCloud2 cloud =
      make_cloud(header, static_cast<std::uint32_t>(scene.points.size()), 1);
  cloud.is_dense = true;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    set_point(cloud, i, scene.points[i].position, scene.points[i].bgr.data());
  }
  return cloud;
}

rprr_msgs::PairStatistics statistics_message(const RebuiltFrame& frame,
                                             const std_msgs::Header& header) {
  const auto u32 = [](std::size_t value) { return static_cast<std::uint32_t>(value); };
  rprr_msgs::PairStatistics statistics;
  statistics.header = header;
  statistics.robot = frame.robot;
  statistics.reference = frame.reference;
  statistics.reference_stamp = frame.sparse ? to_time(frame.reference_stamp) : ros::Time();
  statistics.exchange = frame.exchange;

  statistics.blocks_total = static_cast<std::uint32_t>(frame.blocks_total);
  statistics.blocks_predicted = frame.report.blocks_predicted;
  statistics.blocks_validated = frame.report.blocks_validated;
  statistics.blocks_sent = static_cast<std::uint32_t>(frame.blocks_sent);
  statistics.blocks_sent_without_depth =
      static_cast<std::uint32_t>(frame.blocks_sent_without_depth);
  statistics.blocks_colour_only = static_cast<std::uint32_t>(frame.blocks_colour_only);

  statistics.bytes_pose = frame.report.bytes_pose;
  statistics.bytes_masks = u32(frame.bytes_masks);
  statistics.bytes_depth = u32(frame.sizes.depth);
  statistics.bytes_colour = u32(frame.sizes.colour + frame.sizes.base);
  statistics.bytes_extras = u32(frame.bytes_extras);
  statistics.bytes_total = u32(frame.bytes_total);
  statistics.independent_bytes_depth = frame.report.independent_bytes_depth;
  statistics.independent_bytes_colour = frame.report.independent_bytes_colour;
  statistics.independent_bytes_total =
      frame.report.independent_bytes_depth + frame.report.independent_bytes_colour;

  statistics.ms_pose = frame.report.ms_pose;
  statistics.ms_predict = frame.report.ms_predict;
  statistics.ms_validate = frame.report.ms_validate;
  statistics.ms_encode = frame.report.ms_encode;
  statistics.ms_decode = static_cast<float>(frame.ms_decode);
  statistics.ms_reconstruct = static_cast<float>(frame.ms_reconstruct);
  statistics.energy_mj = static_cast<float>(frame.energy_mj);
  statistics.energy_independent_mj = static_cast<float>(frame.energy_independent_mj);
  statistics.depth_rounded = frame.depth_rounded ? 1 : 0;
  statistics.share_received = static_cast<float>(frame.share_received);
  statistics.share_predicted = static_cast<float>(frame.share_predicted);
  return statistics;
}

visualization_msgs::Marker frustum_message(const RebuiltFrame& frame,
                                           const std_msgs::Header& header, std::size_t number,
                                           double length) {
  // Told apart by those who see red and green alike too.
  constexpr float kColours[][3] = {
      {1.0f, 0.65f, 0.0f}, {0.25f, 0.7f, 1.0f}, {0.0f, 0.8f, 0.5f}, {0.95f, 0.9f, 0.25f}};
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = frame.robot;
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 0.02 * length;  // width of the lines
  const float* colour = kColours[number % (sizeof(kColours) / sizeof(kColours[0]))];
  marker.color.r = colour[0];
  marker.color.g = colour[1];
  marker.color.b = colour[2];
  marker.color.a = 1.0f;
  for (const Eigen::Vector3d& end : frustum_lines(frame.camera, length)) {
    geometry_msgs::Point point;
    point.x = end.x();
    point.y = end.y();
    point.z = end.z();
    marker.points.push_back(point);
  }
  return marker;
}

}  // namespace rprr
