// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <opencv2/core.hpp>

#include "colour/jpeg.hpp"
#include "colour/pgf.hpp"
#include "colour/webp.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

struct Codec {
  ColourCodecInfo (*info)();
  std::unique_ptr<ColourEncoder> (*make_encoder)();
  Result<cv::Size> (*payload_size)(ByteView);
  Result<cv::Mat> (*decode)(ByteView, cv::Size);
};

template <typename Encoder>
std::unique_ptr<ColourEncoder> make() {
  return std::make_unique<Encoder>();
}

constexpr std::array<Codec, 3> kCodecs = {{
    {PgfEncoder::info, make<PgfEncoder>, pgf_payload_size, decode_pgf},
    {JpegEncoder::info, make<JpegEncoder>, jpeg_payload_size, decode_jpeg},
    {WebpEncoder::info, make<WebpEncoder>, webp_payload_size, decode_webp},
}};

const Codec* find(const std::string& name) {
  for (const Codec& codec : kCodecs) {
    if (codec.info().name == name) return &codec;
  }
  return nullptr;
}

Error unknown(const std::string& name) {
  std::string known;
  for (const std::string& other : colour_codecs()) known += (known.empty() ? "" : ", ") + other;
  return Error{"unknown colour codec '" + name + "': this build knows " + known};
}

class LocalDecoder : public ColourDecoder {
 public:
  Result<cv::Mat> decode(const std::string& name, ByteView payload, cv::Size expected) override {
    const Codec* codec = find(name);
    return codec != nullptr ? codec->decode(payload, expected) : Result<cv::Mat>(unknown(name));
  }
};

}  // namespace

Result<cv::Size> colour_payload_size(const std::string& name, ByteView payload) {
  const Codec* codec = find(name);
  return codec != nullptr ? codec->payload_size(payload) : Result<cv::Size>(unknown(name));
}

Result<int> colour_payload_coarse(const std::string& name, ByteView payload) {
  if (name == PgfEncoder::info().name) return pgf_payload_coarse(payload);
  const Result<cv::Size> size = colour_payload_size(name, payload);
  return size ? Result<int>(0) : Result<int>(Error{size.reason()});
}

std::vector<std::string> colour_codecs() {
  std::vector<std::string> names;
  for (const Codec& codec : kCodecs) names.push_back(codec.info().name);
  return names;
}

Result<ColourCodecInfo> colour_codec_info(const std::string& name) {
  const Codec* codec = find(name);
  return codec != nullptr ? codec->info() : Result<ColourCodecInfo>(unknown(name));
}

Result<std::unique_ptr<ColourEncoder>> make_colour_encoder(const std::string& name) {
  const Codec* codec = find(name);
  if (codec == nullptr) return unknown(name);
  return codec->make_encoder();
}

std::unique_ptr<ColourDecoder> make_local_colour_decoder() {
  return std::make_unique<LocalDecoder>();
}

}  // namespace rprr
