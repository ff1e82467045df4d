// SPDX-License-Identifier: BSD-3-Clause
#include "colour/webp.hpp"

#include <webp/decode.h>
#include <webp/encode.h>

#include <opencv2/core.hpp>

#include "colour/checks.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

// RIFF, its length, WEBP, VP8, its length: nothing that we do not know.
constexpr std::size_t kBeforeLength = 16;

// The most that a frame of VGA has time for: method 3 saves a tenth for three times the time.
constexpr int kMethod = 2;
// Segments with a quantiser of their own please the eye; without them a frame takes a third less
// time and has 0.3 dB more at equal bytes.
constexpr int kSegments = 1;
// Half a tenth of a decibel above libwebp's own 60, for nothing.
constexpr int kFilterStrength = 80;

struct Picture {
  WebPPicture picture;
  WebPMemoryWriter writer;
  bool good = false;

  Picture() {
    WebPMemoryWriterInit(&writer);
    good = WebPPictureInit(&picture) != 0;
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &writer;
  }
  ~Picture() {
    WebPPictureFree(&picture);
    WebPMemoryWriterClear(&writer);
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
};

bool configure(WebPConfig& config, int quality) {
  if (!WebPConfigPreset(&config, WEBP_PRESET_DEFAULT, static_cast<float>(quality))) return false;
  config.method = kMethod;
  config.segments = kSegments;
  config.filter_strength = kFilterStrength;
  return WebPValidateConfig(&config) != 0;
}

// RFC 6386, 9.1: a tag of three bytes whose first bit says key frame, a start code, and 14 bits
// each of width and height below 2 bits that ask for scaling.
Result<cv::Size> stated_size(ByteView vp8) {
  ByteReader reader(vp8);
  const ByteView tag = reader.get_view(3);
  const ByteView start = reader.get_view(3);
  const auto width = reader.get<std::uint16_t>();
  const auto height = reader.get<std::uint16_t>();
  if (!reader.ok()) return Error{"colour payload damaged or cut short"};
  if ((tag.data[0] & 1) != 0 || start.data[0] != 0x9D || start.data[1] != 0x01 ||
      start.data[2] != 0x2A) {
    return Error{"colour payload is no key frame of VP8"};
  }
  return possible_size(width, height);  // a scale makes it too large
}

}  // namespace

Result<Bytes> WebpEncoder::encode(const cv::Mat& bgr, int quality) {
  const std::string wrong = unencodable(bgr, quality, info());
  if (!wrong.empty()) return Error{wrong};
  WebPConfig config;
  Picture image;
  if (!image.good || !configure(config, quality)) return Error{"libwebp is of another version"};
  image.picture.width = bgr.cols;
  image.picture.height = bgr.rows;
  if (!WebPPictureImportBGR(&image.picture, bgr.ptr(), static_cast<int>(bgr.step)) ||
      !WebPEncode(&config, &image.picture)) {
    return Error{"encoding WebP: libwebp error " + std::to_string(image.picture.error_code)};
  }
  ByteReader reader({image.writer.mem, image.writer.size});
  reader.get_view(kBeforeLength);
  const ByteView vp8 = reader.get_view(reader.get<std::uint32_t>());  // without the padding
  if (!stated_size(vp8)) return Error{"encoding WebP: libwebp did not write a plain frame"};
  Bytes payload;
  payload.reserve(vp8.size + 4);
  payload.assign(vp8.data, vp8.data + vp8.size);
  seal(payload);
  return payload;
}

Result<cv::Size> webp_payload_size(ByteView payload) {
  return stated_size(unseal(payload));
}

Result<cv::Mat> decode_webp(ByteView payload, cv::Size expected) {
  const ByteView vp8 = unseal(payload);
  const Result<cv::Size> size = stated_size(vp8);
  if (!size) return Error{size.reason()};
  if (*size != expected) return Error{"colour payload is of another size than expected"};
  cv::Mat bgr(expected, CV_8UC3);
  if (WebPDecodeBGRInto(vp8.data, vp8.size, bgr.ptr(), bgr.total() * bgr.elemSize(),
                        static_cast<int>(bgr.step)) == nullptr) {
    return Error{"decoding WebP: damaged"};
  }
  return bgr;
}

}  // namespace rprr
