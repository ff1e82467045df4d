// SPDX-License-Identifier: BSD-3-Clause
#include "transport/depth_message.hpp"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <sstream>

#include "rprr_ros/conversions.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

namespace encodings = sensor_msgs::image_encodings;

std::string format_of(const std::string& encoding, DhcmMode mode, double step) {
  std::ostringstream format;
  format << encoding << "; dhcm " << dhcm_mode_name(mode);
  if (encoding != encodings::TYPE_32FC1) return format.str();
  if (step > 0.0) {
    format << " step " << step;
  } else {
    format << " lossless";
  }
  return format.str();
}

}  // namespace

Result<Bytes> DepthMessageEncoder::encode_float(const sensor_msgs::Image& image, double step) {
  try {
    const auto shared = cv_bridge::toCvShare(image, nullptr, encodings::TYPE_32FC1);
    return encoder_.encode_float(shared->image, step);
  } catch (const std::exception& error) {
    return Error{std::string("image is not what it says: ") + error.what()};
  }
}

Result<sensor_msgs::CompressedImage> DepthMessageEncoder::encode(const sensor_msgs::Image& image,
                                                                 DhcmMode mode, double step) {
  encoder_.set_mode(mode);
  sensor_msgs::CompressedImage message;
  message.header = image.header;
  message.format = format_of(image.encoding, mode, step);
  if (image.encoding == encodings::TYPE_32FC1) {
    Result<Bytes> payload = encode_float(image, step);
    if (!payload) return Error{payload.reason()};
    message.data = std::move(*payload);
    return message;
  }
  const Result<DepthFrame> frame = depth_from_image(image, {});
  if (!frame) return Error{frame.reason()};
  if (frame->width() > kMaxImageSide || frame->height() > kMaxImageSide) {
    return Error{"image has more than " + std::to_string(kMaxImageSide) + " pixels a side"};
  }
  message.data = encoder_.encode(*frame);
  return message;
}

Result<sensor_msgs::Image> DepthMessageDecoder::decode(
    const sensor_msgs::CompressedImage& message) {
  const Result<DhcmInfo> info = dhcm_info(message.data);
  if (!info) return Error{info.reason()};
  if (info->pixels != DhcmPixels::kCounts) {
    const Result<cv::Mat> metres = decoder_.decode_float(message.data);
    if (!metres) return Error{metres.reason()};
    return to_image(message.header, encodings::TYPE_32FC1, *metres);
  }
  const Result<DepthFrame> frame = decoder_.decode(message.data);
  if (!frame) return Error{frame.reason()};
  sensor_msgs::Image image = to_depth_image(message.header, *frame);
  if (message.format.rfind(encodings::MONO16 + ";", 0) == 0 &&
      image.encoding == encodings::TYPE_16UC1) {
    image.encoding = encodings::MONO16;
  }
  return image;
}

}  // namespace rprr
