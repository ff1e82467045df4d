// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_ros/conversions.hpp"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <limits>

namespace rprr {
namespace encodings = sensor_msgs::image_encodings;
namespace {

// cv_bridge and OpenCV throw on sizes that do not fit.
Error not_what_it_says(const std::exception& error) {
  return {std::string("image message does not hold what its size and encoding say; check its "
                      "publisher: ") +
          error.what()};
}

}  // namespace

Stamp to_stamp(const ros::Time& time) {
  return static_cast<Stamp>(time.sec) * 1000000000 + time.nsec;
}

ros::Time to_time(Stamp stamp) {
  const Stamp seconds = stamp / 1000000000;
  if (stamp < 0 || seconds > std::numeric_limits<std::uint32_t>::max()) return {};
  return {static_cast<std::uint32_t>(seconds), static_cast<std::uint32_t>(stamp % 1000000000)};
}

std::string clean_frame(const std::string& frame) {
  const std::size_t start = frame.find_first_not_of('/');
  return start == std::string::npos ? std::string() : frame.substr(start);
}

std::string optical_frame(const std::string& robot) {
  return robot + "_rgb_optical_frame";
}
std::string rebuilt_frame(const std::string& robot) {
  return robot + "_rprr_optical_frame";
}

Result<DepthFrame> depth_from_image(const sensor_msgs::Image& image, const DepthUnits& units) {
  const bool counts = image.encoding == encodings::TYPE_16UC1 || image.encoding == "mono16";
  if (!counts && image.encoding != encodings::TYPE_32FC1) {
    return Error{"encoding '" + image.encoding +
                 "' is not depth; publish 16UC1 (millimetres) or "
                 "32FC1 (metres)"};
  }
  try {
    const auto shared =
        cv_bridge::toCvShare(image, nullptr, counts ? encodings::TYPE_16UC1 : image.encoding);
    return depth_frame_from_image(shared->image, units);
  } catch (const std::exception& error) {
    return not_what_it_says(error);
  }
}

Result<cv::Mat> bgr_from_image(const sensor_msgs::Image& image) {
  if (image.data.empty()) return Error{"colour image is empty; check its publisher"};
  const bool known = encodings::isColor(image.encoding) || encodings::isMono(image.encoding) ||
                     encodings::isBayer(image.encoding);
  if (!known || encodings::bitDepth(image.encoding) != 8) {
    return Error{"encoding '" + image.encoding +
                 "' is not 8-bit colour; publish bgr8, rgb8, mono8 or 8-bit Bayer"};
  }
  try {
    return cv_bridge::toCvShare(image, nullptr, encodings::BGR8)->image;
  } catch (const std::exception& error) {
    return not_what_it_says(error);
  }
}

sensor_msgs::Image to_image(const std_msgs::Header& header, const std::string& encoding,
                            const cv::Mat& pixels) {
  sensor_msgs::Image image;
  cv_bridge::CvImage(header, encoding, pixels).toImageMsg(image);
  return image;
}

sensor_msgs::Image to_depth_image(const std_msgs::Header& header, const DepthFrame& frame) {
  if (frame.unit == 0.001) return to_image(header, encodings::TYPE_16UC1, frame.counts);
  return to_image(header, encodings::TYPE_32FC1, to_float_image(frame));
}

Pose pose_from_fields(const boost::array<double, 3>& translation,
                      const boost::array<double, 4>& rotation) {
  return make_pose({translation[0], translation[1], translation[2]},
                   {rotation[0], rotation[1], rotation[2], rotation[3]});
}

void pose_to_fields(const Pose& pose, boost::array<double, 3>& translation,
                    boost::array<double, 4>& rotation) {
  const Eigen::Quaterniond q(pose.linear());
  for (int i = 0; i < 3; ++i) translation[static_cast<std::size_t>(i)] = pose.translation()[i];
  rotation = {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace rprr
