// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace rprr {

/// A cloud of width x height points of fields x y z (float32) and rgb, all zero yet. May hold NaN.
sensor_msgs::PointCloud2 make_cloud(const std_msgs::Header& header, std::uint32_t width,
                                    std::uint32_t height);
/// Writes one point of a cloud that make_cloud made. bgr: three bytes.
void set_point(sensor_msgs::PointCloud2& cloud, std::size_t index, const Eigen::Vector3f& position,
               const std::uint8_t* bgr);

}  // namespace rprr
