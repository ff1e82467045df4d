// SPDX-License-Identifier: BSD-3-Clause
#include "pictures.hpp"

#include <rprr_msgs/BlockMask.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/image_encodings.h>

#include <vector>

#include "rprr_redundancy/sparse_image.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_ros/point_cloud.hpp"
#include "rprr_wire/mask_wire.hpp"

namespace rprr {
namespace {

namespace encodings = sensor_msgs::image_encodings;

std_msgs::Header header_of(const RgbdFrame& frame) {
  std_msgs::Header header;
  header.stamp = to_time(frame.stamp);
  header.frame_id = frame.frame_id;
  return header;
}

sensor_msgs::PointCloud2 preview_cloud(const std_msgs::Header& header,
                                       const std::vector<PreviewPoint>& points) {
  sensor_msgs::PointCloud2 cloud = make_cloud(header, static_cast<std::uint32_t>(points.size()), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    set_point(cloud, i, points[i].position, points[i].bgr.val);
  }
  return cloud;
}

}  // namespace

Pictures::Pictures(ros::NodeHandle& nh, const std::string& robot) {
  const std::string prefix = "/" + robot + "/rprr/";
  validation_ = nh.advertise<rprr_msgs::BlockMask>(prefix + "validation", 2);
  mask_ = nh.advertise<sensor_msgs::Image>(prefix + "mask", 2);
  rgb_ = nh.advertise<sensor_msgs::Image>(prefix + "sparse/rgb", 2);
  depth_ = nh.advertise<sensor_msgs::Image>(prefix + "sparse/depth", 2);
  decision_ = nh.advertise<sensor_msgs::Image>(prefix + "decision", 2);
  points_ = nh.advertise<sensor_msgs::PointCloud2>(prefix + "preview_points", 2);
}

void Pictures::show(const ValidatedBlocks& blocks) {
  if (validation_.getNumSubscribers() == 0) return;
  rprr_msgs::BlockMask message;
  message.header = header_of(*blocks.frame);
  message.exchange = blocks.exchange;
  message.data = encode_mask(blocks.blocks);
  validation_.publish(message);
}

void Pictures::show(const OutgoingFrame& outgoing) {
  const RgbdFrame& frame = *outgoing.frame;
  const BlockMask all(BlockGrid(frame.camera.width, frame.camera.height), true);
  const BlockMask& mask = outgoing.sparse ? outgoing.mask : all;
  if (mask_.getNumSubscribers() > 0) {
    mask_.publish(to_image(header_of(frame), encodings::MONO8, mask.to_image()));
  }
  if (rgb_.getNumSubscribers() > 0) {
    if (const Result<cv::Mat> rgb = keep_blocks(frame.bgr, mask)) {
      rgb_.publish(to_image(header_of(frame), encodings::BGR8, *rgb));
    }
  }
  if (depth_.getNumSubscribers() > 0) {
    const BlockMask& depth_mask = outgoing.sparse ? outgoing.depth_mask : all;
    if (const Result<cv::Mat> counts = keep_blocks(frame.depth.counts, depth_mask)) {
      depth_.publish(to_depth_image(header_of(frame), {*counts, frame.depth.unit}));
    }
  }
}

void Pictures::show(const BlockRequest& request) {
  if (!request.decision.from_preview || !request.preview) return;
  std_msgs::Header header;
  header.stamp = to_time(request.stamp);
  if (decision_.getNumSubscribers() > 0) {
    header.frame_id = optical_frame(request.receiver);
    decision_.publish(to_image(header, encodings::BGR8,
                               decision_picture(request.preview->preview, request.decision.send)));
  }
  if (points_.getNumSubscribers() > 0) {
    header.frame_id = rebuilt_frame(request.receiver);
    points_.publish(
        preview_cloud(header, preview_points(request.preview->preview, request.camera)));
  }
}

}  // namespace rprr
