// SPDX-License-Identifier: BSD-3-Clause
#include "transport/colour_message.hpp"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>

#include "rprr_ros/conversions.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

namespace encodings = sensor_msgs::image_encodings;

std::string encoding_after(const std::string& encoding) {
  return encoding == encodings::RGB8 || encoding == encodings::MONO8 ? encoding : encodings::BGR8;
}

// The encoding that a format names; bgr8 for formats that none of our publishers wrote.
std::string encoding_in(const std::string& format) {
  return encoding_after(format.substr(0, format.find(';')));
}

}  // namespace

Result<sensor_msgs::CompressedImage> ColourMessageEncoder::encode(const sensor_msgs::Image& image,
                                                                  int quality) {
  const Result<cv::Mat> bgr = bgr_from_image(image);
  if (!bgr) return Error{bgr.reason()};
  if (!encoder_) {
    Result<std::unique_ptr<ColourEncoder>> made = make_colour_encoder("pgf");
    if (!made) return Error{made.reason()};
    encoder_ = std::move(*made);
  }
  Result<Bytes> payload = encoder_->encode(*bgr, quality);
  if (!payload) return Error{payload.reason()};
  sensor_msgs::CompressedImage message;
  message.header = image.header;
  message.format = encoding_after(image.encoding) + "; pgf " +
                   (quality == 0 ? "lossless" : "quality " + std::to_string(quality));
  message.data = std::move(*payload);
  return message;
}

void ColourMessageDecoder::set_limits(const WorkerLimits& limits, std::size_t max_pixels) {
  max_pixels_ = max_pixels;
  if (decoder_ && limits.seconds == seconds_) return;
  seconds_ = limits.seconds;
  decoder_ = make_isolated_colour_decoder(limits);
}

Result<sensor_msgs::Image> ColourMessageDecoder::decode(
    const sensor_msgs::CompressedImage& message) {
  const Result<cv::Size> size = colour_payload_size("pgf", message.data);
  if (!size) return Error{size.reason()};
  if (static_cast<std::size_t>(size->area()) > max_pixels_) {
    return Error{"image of " + std::to_string(size->width) + "x" + std::to_string(size->height) +
                 " pixels is beyond the subscriber's max_megapixels"};
  }
  if (!decoder_) return Error{"no limits are set"};
  const Result<cv::Mat> bgr = decoder_->decode("pgf", message.data, *size);
  if (!bgr) return Error{bgr.reason()};
  const auto image = boost::make_shared<cv_bridge::CvImage>(message.header, encodings::BGR8, *bgr);
  const std::string encoding = encoding_in(message.format);
  sensor_msgs::Image out;
  (encoding == encodings::BGR8 ? cv_bridge::CvImageConstPtr(image)
                               : cv_bridge::CvImageConstPtr(cv_bridge::cvtColor(image, encoding)))
      ->toImageMsg(out);
  return out;
}

}  // namespace rprr
