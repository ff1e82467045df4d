// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// A lossy codec of whole colour images as the evaluation sees it: ours and peers alike. Given its
/// own output only; one object serves one thread and runs on one.
class WholeColour {
 public:
  virtual ~WholeColour() = default;
  virtual std::string name() const = 0;
  /// Settings on the codec's own scale, coarsest first, spread over all that are not lossless.
  virtual std::vector<double> settings() const = 0;
  /// Codes an image (BGR) as a payload for the radio, with its seal.
  /// Precondition: a continuous CV_8UC3.
  virtual Result<Bytes> encode(const cv::Mat& bgr, double setting) = 0;
  virtual Result<cv::Mat> decode(ByteView payload, cv::Size size) = 0;
};

/// pgf, jpeg, webp, and jxl if libjxl is here: JPEG XL at effort 3, settings its distance.
std::vector<std::unique_ptr<WholeColour>> make_whole_colours();

}  // namespace rprr
