// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <memory>
#include <string>

#include "rprr_codec/colour_codec.hpp"

namespace rprr {

/// Colour images as transport `pgf` sends them: "<encoding>; pgf quality 6" or "...; pgf lossless",
/// where the encoding is that of the image that comes out: bgr8, rgb8 or mono8 as it went in, bgr8
/// of everything else (Bayer patterns are resolved, transparency is dropped).
class ColourMessageEncoder {
 public:
  /// quality: 0 lossless, 1 finest, 30 coarsest. Errors: not 8-bit colour, data that do not fit
  /// the stated size.
  Result<sensor_msgs::CompressedImage> encode(const sensor_msgs::Image& image, int quality);

 private:
  std::unique_ptr<ColourEncoder> encoder_;
};

/// Pixels are decoded in a worker process, which hostile bytes may kill without harm to this one.
class ColourMessageDecoder {
 public:
  /// Limits hold from the next image on.
  void set_limits(const WorkerLimits& limits, std::size_t max_pixels);
  /// Any message: what ColourMessageEncoder did not write is an error.
  Result<sensor_msgs::Image> decode(const sensor_msgs::CompressedImage& message);

 private:
  double seconds_ = 0.0;
  std::size_t max_pixels_ = 0;
  std::unique_ptr<ColourDecoder> decoder_;
};

}  // namespace rprr
