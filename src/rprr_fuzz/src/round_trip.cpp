// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as an image, whole, in blocks and as floats, in every mode: it comes back as it was.
#include <cstring>
#include <opencv2/core.hpp>

#include "fuzz.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace {

using namespace rprr;

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

void counts(DhcmEncoder& encoder, DhcmDecoder& decoder, const cv::Mat& image) {
  const DepthFrame frame = {image, 0.001};
  const Bytes payload = encoder.encode(frame);
  fuzz::require(payload.size() <= dhcm_bound(image.size()));
  const Result<DepthFrame> back = decoder.decode(payload);
  fuzz::require(back && same_bytes(back->counts, image));
  BlockMask mask(BlockGrid(image.cols, image.rows));
  for (int block = 0; block < mask.grid().count(); ++block) {
    mask.set(block, (image.data[block % (2 * image.cols)] & 1) != 0);
  }
  const Result<DepthFrame> blocks = decoder.decode(encoder.encode(frame, mask), mask);
  cv::Mat sent = cv::Mat::zeros(image.size(), image.type());
  image.copyTo(sent, mask.to_image());
  fuzz::require(blocks && same_bytes(blocks->counts, sent));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 6) return 0;
  static DhcmEncoder encoder;
  static DhcmDecoder decoder;
  encoder.set_mode(static_cast<DhcmMode>(data[0] % 3));
  const int width = 1 + data[1] % 80;
  const std::size_t pixels = (size - 2) / 2;
  const int height = static_cast<int>(pixels) / width;
  if (height < 1 || height > 512) return 0;
  // Copied, so that an overrun is seen.
  cv::Mat image(height, width, CV_16UC1);
  std::memcpy(image.data, data + 2, image.total() * 2);
  counts(encoder, decoder, image);
  if (width % 2 != 0) return 0;
  cv::Mat metres(height, width / 2, CV_32FC1);
  std::memcpy(metres.data, image.data, metres.total() * 4);
  const Result<Bytes> payload = encoder.encode_float(metres, 0.0);
  fuzz::require(static_cast<bool>(payload));
  const Result<cv::Mat> back = decoder.decode_float(*payload);
  fuzz::require(back && same_bytes(*back, metres));
  encoder.encode_float(metres, 0.001);
  return 0;
}
