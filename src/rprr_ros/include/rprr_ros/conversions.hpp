// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <boost/array.hpp>
#include <opencv2/core/mat.hpp>
#include <string>

#include "rprr_geometry/camera.hpp"
#include "rprr_geometry/depth_frame.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_geometry/se3.hpp"
#include "rprr_geometry/stamp.hpp"

namespace rprr {

Stamp to_stamp(const ros::Time& time);
/// Stamps that ros::Time cannot hold (negative, or beyond 32 bits of seconds) become zero.
ros::Time to_time(Stamp stamp);

/// A tf2 frame name: leading slashes of old bags removed.
std::string clean_frame(const std::string& frame);
/// "<robot>_rgb_optical_frame", where a camera publishes, and "<robot>_rprr_optical_frame", where
/// the rebuilt view lives.
std::string optical_frame(const std::string& robot);
std::string rebuilt_frame(const std::string& robot);

/// Counts of a 16UC1 or 32FC1 image. A 16UC1 frame shares the message's pixels: keep the message
/// alive.
Result<DepthFrame> depth_from_image(const sensor_msgs::Image& image, const DepthUnits& units);
/// CV_8UC3 BGR. A bgr8 image shares the message's pixels: keep the message alive.
Result<cv::Mat> bgr_from_image(const sensor_msgs::Image& image);

/// Copies pixels into an image message of the given encoding (sensor_msgs/image_encodings.h).
sensor_msgs::Image to_image(const std_msgs::Header& header, const std::string& encoding,
                            const cv::Mat& pixels);
/// 16UC1 where the frame's unit is a millimetre, else 32FC1 metres, which keeps the counts.
sensor_msgs::Image to_depth_image(const std_msgs::Header& header, const DepthFrame& frame);

/// Pose <-> the translation and rotation (x y z w) fields of our messages.
Pose pose_from_fields(const boost::array<double, 3>& translation,
                      const boost::array<double, 4>& rotation);
void pose_to_fields(const Pose& pose, boost::array<double, 3>& translation,
                    boost::array<double, 4>& rotation);

}  // namespace rprr
