// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/core.hpp>

#include "colour/pgf.hpp"
#include "rprr_codec/colour_codec.hpp"

namespace rprr {
namespace {

class LocalDecoder : public ColourDecoder {
 public:
  Result<cv::Mat> decode(const std::string& codec, ByteView payload, cv::Size expected) override {
    if (codec == "pgf") return decode_pgf(payload, expected);
    return Error{"unknown colour codec '" + codec + "'"};
  }
};

}  // namespace

Result<cv::Size> colour_payload_size(const std::string& codec, ByteView payload) {
  if (codec == "pgf") return pgf_payload_size(payload);
  return Error{"unknown colour codec '" + codec + "'"};
}

std::vector<std::string> colour_codecs() {
  return {"pgf"};
}

Result<std::unique_ptr<ColourEncoder>> make_colour_encoder(const std::string& codec, int quality) {
  if (codec != "pgf") return Error{"unknown colour codec '" + codec + "': this build knows pgf"};
  if (quality < 0 || quality > kPgfMaxQuality) {
    return Error{"quality of pgf is " + std::to_string(quality) + ", must be 0 (lossless) to " +
                 std::to_string(kPgfMaxQuality)};
  }
  return std::unique_ptr<ColourEncoder>(std::make_unique<PgfEncoder>(quality));
}

std::unique_ptr<ColourDecoder> make_local_colour_decoder() {
  return std::make_unique<LocalDecoder>();
}

}  // namespace rprr
