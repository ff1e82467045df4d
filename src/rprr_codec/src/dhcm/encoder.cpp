// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "dhcm/body_encoder.hpp"
#include "dhcm/container.hpp"
#include "dhcm/float_image.hpp"
#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/block_mask.hpp"
#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

struct DhcmEncoder::Buffers {
  dhcm::BodyEncoder encoder;
  Bytes body;

  Bytes encode(const DepthFrame& frame, const BlockMask* mask, DhcmMode mode,
               DhcmPixels pixels = DhcmPixels::kCounts);
};

Bytes DhcmEncoder::Buffers::encode(const DepthFrame& frame, const BlockMask* mask, DhcmMode mode,
                                   DhcmPixels pixels) {
  const dhcm::CountsView counts = {frame.counts.ptr<std::uint16_t>(), frame.counts.step1(),
                                   frame.width(), frame.height()};
  const dhcm::Body kind = encoder.encode(counts, mask, mode, body);
  Bytes out;
  out.reserve(body.size() + dhcm::kMostAround);
  dhcm::begin({kind, mode, pixels, mask != nullptr, frame.width(), frame.height(), frame.unit},
              out);
  out.insert(out.end(), body.begin(), body.end());
  dhcm::finish(out);
  return out;
}

DhcmEncoder::DhcmEncoder(DhcmMode mode) : buffers_(std::make_unique<Buffers>()), mode_(mode) {
}
DhcmEncoder::~DhcmEncoder() = default;

Bytes DhcmEncoder::encode(const DepthFrame& frame) {
  return buffers_->encode(frame, nullptr, mode_);
}

Bytes DhcmEncoder::encode(const DepthFrame& frame, const BlockMask& blocks) {
  return buffers_->encode(frame, &blocks, mode_);
}

Result<Bytes> DhcmEncoder::encode_float(const cv::Mat& metres, double step) {
  if (metres.type() != CV_32FC1) return Error{"depth image is not 32FC1"};
  if (metres.empty() || metres.cols > kMaxImageSide || metres.rows > kMaxImageSide) {
    return Error{"depth image has an impossible size"};
  }
  if (!std::isfinite(step) || step < 0.0)
    return Error{"quantisation step is negative or no number"};
  if (step > 0.0) {
    const Result<DepthFrame> frame = dhcm::quantise(metres, step);
    if (!frame) return Error{frame.reason()};
    return buffers_->encode(*frame, nullptr, mode_, DhcmPixels::kQuantisedFloat);
  }
  return dhcm::pack_float(metres, mode_, [this](const DepthFrame& plane) { return encode(plane); });
}

}  // namespace rprr
