// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/core.hpp>

#include "dhcm/body_decoder.hpp"
#include "dhcm/container.hpp"
#include "dhcm/float_image.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

struct DhcmDecoder::Buffers {
  dhcm::BodyDecoder decoder;

  Result<DepthFrame> decode(const dhcm::Opened& opened, const BlockMask* mask,
                            std::size_t max_pixels, const cv::Mat& reuse = {});
};

Result<DepthFrame> DhcmDecoder::Buffers::decode(const dhcm::Opened& opened, const BlockMask* mask,
                                                std::size_t max_pixels, const cv::Mat& reuse) {
  const dhcm::Header& header = opened.header;
  if (header.masked != (mask != nullptr)) {
    return Error{mask != nullptr ? "depth payload of a whole frame where blocks were expected"
                                 : "depth payload of some blocks where a whole frame was expected"};
  }
  const auto width = static_cast<std::size_t>(header.width);
  const auto height = static_cast<std::size_t>(header.height);
  if (width * height > max_pixels) return Error{"depth image is larger than allowed"};
  if (mask != nullptr &&
      (mask->grid().width != header.width || mask->grid().height != header.height)) {
    return Error{"depth payload is of another size than its block mask"};
  }
  DepthFrame frame;
  frame.unit = header.unit;
  // Zeroed by blocks that are not sent; a whole frame writes every pixel.
  frame.counts = reuse;
  frame.counts.create(header.height, header.width, CV_16UC1);
  if (mask != nullptr) frame.counts.setTo(0);
  const dhcm::CountsTarget target = {frame.counts.ptr<std::uint16_t>(), frame.counts.step1(),
                                     header.width, header.height};
  if (!decoder.decode(header.body, opened.body, mask, target))
    return Error{"depth payload is malformed"};
  return frame;
}

DhcmDecoder::DhcmDecoder(std::size_t max_pixels)
    : buffers_(std::make_unique<Buffers>()), max_pixels_(max_pixels) {
}
DhcmDecoder::~DhcmDecoder() = default;

namespace {

Result<dhcm::Opened> open_counts(ByteView payload) {
  Result<dhcm::Opened> opened = dhcm::open(payload);
  if (opened && opened->header.pixels != DhcmPixels::kCounts) {
    return Error{"depth payload of a 32FC1 image where counts were expected"};
  }
  return opened;
}

}  // namespace

Result<DepthFrame> DhcmDecoder::decode(ByteView payload) {
  const Result<dhcm::Opened> opened = open_counts(payload);
  if (!opened) return Error{opened.reason()};
  return buffers_->decode(*opened, nullptr, max_pixels_);
}

Result<DepthFrame> DhcmDecoder::decode(ByteView payload, cv::Size expected, const cv::Mat& reuse) {
  const Result<dhcm::Opened> opened = open_counts(payload);
  if (!opened) return Error{opened.reason()};
  if (opened->header.width != expected.width || opened->header.height != expected.height) {
    return Error{"depth payload is of another size than expected"};
  }
  return buffers_->decode(*opened, nullptr, max_pixels_, reuse);
}

Result<DepthFrame> DhcmDecoder::decode(ByteView payload, const BlockMask& blocks) {
  const Result<dhcm::Opened> opened = open_counts(payload);
  if (!opened) return Error{opened.reason()};
  return buffers_->decode(*opened, &blocks, max_pixels_);
}

Result<cv::Mat> DhcmDecoder::decode_float(ByteView payload) {
  const Result<dhcm::Opened> opened = dhcm::open(payload);
  if (!opened) return Error{opened.reason()};
  const dhcm::Header& header = opened->header;
  if (header.pixels == DhcmPixels::kCounts) {
    return Error{"depth payload of counts where a 32FC1 image was expected"};
  }
  if (header.pixels == DhcmPixels::kFloat) {
    const cv::Size size(header.width, header.height);
    return dhcm::unpack_float(*opened, [&](ByteView plane) { return decode(plane, size); });
  }
  const Result<DepthFrame> frame = buffers_->decode(*opened, nullptr, max_pixels_);
  if (!frame) return Error{frame.reason()};
  return to_float_image(*frame);
}

}  // namespace rprr
