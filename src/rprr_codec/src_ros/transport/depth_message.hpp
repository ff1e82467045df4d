// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Depth images as transport `dhcm` sends them. `format` is for people and for the encoding's name;
/// the payload alone says what its pixels are:
///   "16UC1; dhcm default"                 counts as they came (also mono16)
///   "32FC1; dhcm default lossless"        metres, bit by bit
///   "32FC1; dhcm default step 0.001"      metres, rounded to whole steps
class DepthMessageEncoder {
 public:
  /// step: of 32FC1 images, metres; 0 is lossless. Errors: another encoding, data that do not fit
  /// the stated size, readings that the step cannot hold.
  Result<sensor_msgs::CompressedImage> encode(const sensor_msgs::Image& image, DhcmMode mode,
                                              double step);

 private:
  Result<Bytes> encode_float(const sensor_msgs::Image& image, double step);

  DhcmEncoder encoder_;
};

class DepthMessageDecoder {
 public:
  explicit DepthMessageDecoder(std::size_t max_pixels) : decoder_(max_pixels) {}

  /// Any message: what DepthMessageEncoder did not write is an error.
  Result<sensor_msgs::Image> decode(const sensor_msgs::CompressedImage& message);

 private:
  DhcmDecoder decoder_;
};

}  // namespace rprr
