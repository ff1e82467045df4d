// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/point_cloud.hpp"

#include <cstring>
#include <string>

namespace rprr {
namespace {

constexpr std::uint32_t kPointBytes = 16;

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

sensor_msgs::PointCloud2 make_cloud(const std_msgs::Header& header, std::uint32_t width,
                                    std::uint32_t height) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.width = width;
  cloud.height = height;
  cloud.fields = {point_field("x", 0), point_field("y", 4), point_field("z", 8),
                  point_field("rgb", 12)};
  cloud.is_bigendian = !little_endian();
  cloud.point_step = kPointBytes;
  cloud.row_step = kPointBytes * width;
  cloud.is_dense = false;
  cloud.data.resize(static_cast<std::size_t>(cloud.row_step) * height);
  return cloud;
}

void set_point(sensor_msgs::PointCloud2& cloud, std::size_t index, const Eigen::Vector3f& position,
               const std::uint8_t* bgr) {
  std::uint8_t* out = cloud.data.data() + index * kPointBytes;
  const std::uint32_t rgb =
      static_cast<std::uint32_t>(bgr[2]) << 16 | static_cast<std::uint32_t>(bgr[1]) << 8 | bgr[0];
  std::memcpy(out, position.data(), 12);
  std::memcpy(out + 12, &rgb, sizeof(rgb));
}

}  // namespace rprr
