// SPDX-License-Identifier: BSD-3-Clause
#include "station_messages.hpp"

#include <sensor_msgs/image_encodings.h>

#include <cstring>
#include <limits>

#include "rprr_geometry_ros/conversions.hpp"

namespace rprr {
namespace {

sensor_msgs::PointField point_field(const std::string& name, std::uint32_t offset) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  return field;
}

bool little_endian() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

}  // namespace

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
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.width = static_cast<std::uint32_t>(frame.camera.width);
  cloud.height = static_cast<std::uint32_t>(frame.camera.height);
  cloud.fields = {point_field("x", 0), point_field("y", 4), point_field("z", 8),
                  point_field("rgb", 12)};
  cloud.is_bigendian = !little_endian();
  cloud.point_step = 16;
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.is_dense = false;
  cloud.data.resize(static_cast<std::size_t>(cloud.row_step) * cloud.height);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::uint8_t* out = cloud.data.data();
  for (int v = 0; v < frame.camera.height; ++v) {
    const auto* colour = frame.bgr.ptr<std::uint8_t>(v);
    for (int u = 0; u < frame.camera.width; ++u, colour += 3, out += cloud.point_step) {
      float xyz[3] = {kNone, kNone, kNone};
      const double z = frame.depth.metres(u, v);
      if (z > 0) {
        const Eigen::Vector3f point = frame.camera.unproject(u, v, z).cast<float>();
        for (int i = 0; i < 3; ++i) xyz[i] = point[i];
      }
      const std::uint32_t rgb = static_cast<std::uint32_t>(colour[2]) << 16 |
                                static_cast<std::uint32_t>(colour[1]) << 8 | colour[0];
      std::memcpy(out, xyz, sizeof(xyz));
      std::memcpy(out + 12, &rgb, sizeof(rgb));
    }
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
  statistics.bytes_colour = u32(frame.sizes.colour);
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
  statistics.share_received = static_cast<float>(frame.share_received);
  statistics.share_predicted = static_cast<float>(frame.share_predicted);
  return statistics;
}

}  // namespace rprr
