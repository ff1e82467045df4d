// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rprr_msgs/PairStatistics.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include <string>

#include "rprr_station/scene_cloud.hpp"
#include "rprr_station/station.hpp"
#include "rprr_station/station_options.hpp"

namespace rprr {

/// The sender's stamp; the frame in which the view lives: the sender's own for a whole one,
/// <robot>_rprr_optical_frame for a rebuilt one.
std_msgs::Header header_of(const RebuiltFrame& frame);

sensor_msgs::Image depth_message(const RebuiltFrame& frame, const std_msgs::Header& header,
                                 DepthEncoding encoding);

/// Organised, x y z rgb, NaN where there is no depth.
sensor_msgs::PointCloud2 cloud_message(const RebuiltFrame& frame, const std_msgs::Header& header);

/// The view's camera as a pyramid of lines, length metres long, in the view's frame. number chooses
/// the colour.
visualization_msgs::Marker frustum_message(const RebuiltFrame& frame,
                                           const std_msgs::Header& header, std::size_t number,
                                           double length);

/// All but latency_ms, which needs a clock.
/// Unorganised, x y z rgb, in the reference's optical frame and of its stamp.
sensor_msgs::PointCloud2 scene_message(const Scene& scene);

rprr_msgs::PairStatistics statistics_message(const RebuiltFrame& frame,
                                             const std_msgs::Header& header);

}  // namespace rprr
