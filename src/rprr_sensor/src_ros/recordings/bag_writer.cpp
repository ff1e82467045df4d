// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor_ros/bag_writer.hpp"

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <utility>

#include "recordings/close_bag.hpp"
#include "rprr_ros/camera_info.hpp"
#include "rprr_ros/conversions.hpp"
#include "rprr_sensor_ros/frame_messages.hpp"

namespace rprr {
namespace {

geometry_msgs::TransformStamped transform(const std_msgs::Header& header, const std::string& child,
                                          const Pose& parent_from_child) {
  geometry_msgs::TransformStamped message;
  message.header = header;
  message.child_frame_id = child;
  const Eigen::Quaterniond q(parent_from_child.rotation());
  message.transform.translation.x = parent_from_child.translation().x();
  message.transform.translation.y = parent_from_child.translation().y();
  message.transform.translation.z = parent_from_child.translation().z();
  message.transform.rotation.x = q.x();
  message.transform.rotation.y = q.y();
  message.transform.rotation.z = q.z();
  message.transform.rotation.w = q.w();
  return message;
}

std::string part_of(const std::string& path) {
  return path + ".part";
}

Pose offset(double y) {
  Pose pose = Pose::Identity();
  pose.translation().y() = y;
  return pose;
}

/// x forward, y left, z up, as seen from an optical frame's parent.
Pose optical_turn() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return pose;
}

/// The chain of the benchmark's bags from the world to the colour camera.
tf2_msgs::TFMessage tum_transforms(const ros::Time& stamp, const Pose& world_from_optical) {
  const Pose camera_from_optical = offset(-0.045) * optical_turn();
  std_msgs::Header header;
  header.stamp = stamp;
  tf2_msgs::TFMessage message;
  const auto link = [&](const std::string& parent, const std::string& child, const Pose& pose) {
    header.frame_id = parent;
    message.transforms.push_back(transform(header, child, pose));
  };
  link("/world", "/kinect", world_from_optical * camera_from_optical.inverse());
  link("/kinect", "/openni_camera", Pose::Identity());
  link("/openni_camera", "/openni_rgb_frame", offset(-0.045));
  link("/openni_rgb_frame", "/openni_rgb_optical_frame", optical_turn());
  return message;
}

Result<sensor_msgs::Image> depth_message(const std_msgs::Header& header, const DepthFrame& depth,
                                         DepthEncoding encoding) {
  if (encoding == DepthEncoding::metres) {
    return to_image(header, sensor_msgs::image_encodings::TYPE_32FC1, to_float_image(depth));
  }
  if (encoding == DepthEncoding::millimetres && depth.unit != 0.001) {
    return Error{"16UC1 would round depth of another unit than 1 mm; use 32FC1"};
  }
  return to_depth_image(header, depth);
}

}  // namespace

BagWriter::BagWriter(const std::string& path, std::unique_ptr<rosbag::Bag> bag)
    : path_(path), bag_(std::move(bag)) {
}
BagWriter::BagWriter(BagWriter&&) noexcept = default;
BagWriter& BagWriter::operator=(BagWriter&&) noexcept = default;

BagWriter::~BagWriter() {
  if (!bag_) return;
  const std::string part = part_of(path_);
  close_bag(bag_, part, part);
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
}

Result<std::string> BagWriter::finish() {
  const std::string problem = close_bag(bag_, part_of(path_), path_);
  if (!problem.empty()) return Error{problem};
  return path_;
}

Result<BagWriter> BagWriter::create(const std::string& path, const std::string& compression) {
  try {
    auto bag = std::make_unique<rosbag::Bag>(part_of(path), rosbag::bagmode::Write);
    if (compression == "bz2") {
      bag->setCompression(rosbag::compression::BZ2);
    } else if (compression == "lz4") {
      bag->setCompression(rosbag::compression::LZ4);
    } else if (compression != "none") {
      return Error{"compression '" + compression + "' is none of none, bz2 and lz4"};
    }
    return BagWriter(path, std::move(bag));
  } catch (const std::exception& error) {
    return Error{path + ": cannot be written: " + error.what()};
  }
}

Result<int> BagWriter::add(const RecordedFrame& frame, const Camera& camera,
                           const std::string& robot, BagShape shape, DepthEncoding encoding) {
  const bool tum = shape == BagShape::tum;
  std_msgs::Header header;
  header.stamp = to_time(frame.stamp);
  header.frame_id = tum ? "/openni_rgb_optical_frame" : optical_frame(robot);
  std_msgs::Header depth_header = header;
  if (tum && frame.depth_stamp) depth_header.stamp = to_time(*frame.depth_stamp);
  if (std::min(header.stamp, depth_header.stamp) < ros::TIME_MIN) {
    return Error{"a bag cannot hold stamps before 1 ns"};
  }
  const auto depth =
      depth_message(depth_header, frame.image.depth, tum ? DepthEncoding::metres : encoding);
  if (!depth) return Error{depth.reason()};
  const auto colour = to_image(header, sensor_msgs::image_encodings::BGR8, frame.image.bgr);
  const auto info = info_from_camera(camera, header);
  const InputTopics topics = tum ? tum_topics() : input_topics(robot);
  try {
    bag_->write(topics.colour, header.stamp, colour);
    bag_->write(topics.camera_info, header.stamp, info);
    bag_->write(topics.depth, depth_header.stamp, *depth);
    int messages = 3;
    if (tum) {
      bag_->write("/camera/depth/camera_info", depth_header.stamp,
                  info_from_camera(camera, depth_header));
      ++messages;
    }
    if (frame.world_from_camera) {
      if (tum) {
        bag_->write("/tf", header.stamp, tum_transforms(header.stamp, *frame.world_from_camera));
      } else {
        bag_->write(topics.pose, header.stamp,
                    pose_message(header.stamp, *frame.world_from_camera));
      }
      ++messages;
    }
    return messages;
  } catch (const std::exception& error) {
    return Error{path_ + ": cannot be written: " + error.what() + "; is the disk full?"};
  }
}

}  // namespace rprr
