// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/codec/whole_colour.hpp"

#include <cmath>

#include "codec/peers/makers.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

struct Scale {
  const char* codec;
  std::vector<double> settings;
};

const std::vector<Scale>& scales() {
  static const std::vector<Scale> kScales = {
      {"pgf", {30, 16, 12, 10, 9, 8, 7, 6, 5, 4, 3, 1}},
      {"jpeg", {1, 4, 8, 14, 22, 32, 45, 60, 75, 86, 94, 100}},
      {"webp", {0, 3, 8, 15, 25, 40, 52, 66, 78, 88, 95, 100}},
  };
  return kScales;
}

// What robots can send.
class Ours : public WholeColour {
 public:
  Ours(std::unique_ptr<ColourEncoder> encoder, std::vector<double> settings)
      : encoder_(std::move(encoder)),
        decoder_(make_local_colour_decoder()),
        settings_(std::move(settings)) {}

  std::string name() const override { return encoder_->name(); }
  std::vector<double> settings() const override { return settings_; }
  Result<Bytes> encode(const cv::Mat& bgr, double setting) override {
    return encoder_->encode(bgr, static_cast<int>(std::lround(setting)));
  }
  Result<cv::Mat> decode(ByteView payload, cv::Size size) override {
    return decoder_->decode(name(), payload, size);
  }

 private:
  std::unique_ptr<ColourEncoder> encoder_;
  std::unique_ptr<ColourDecoder> decoder_;
  std::vector<double> settings_;
};

}  // namespace

std::vector<std::unique_ptr<WholeColour>> make_whole_colours() {
  std::vector<std::unique_ptr<WholeColour>> codecs;
  for (const Scale& scale : scales()) {
    auto encoder = make_colour_encoder(scale.codec);
    if (encoder) codecs.push_back(std::make_unique<Ours>(std::move(*encoder), scale.settings));
  }
  if (auto peer = make_jpeg_xl_colour(3)) codecs.push_back(std::move(peer));
  return codecs;
}

}  // namespace rprr
