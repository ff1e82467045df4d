// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/makers.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

class Dhcm : public DepthCodec {
 public:
  explicit Dhcm(DhcmMode mode) : encoder_(mode) {}

  bool encode(const cv::Mat& counts, Bytes& coded) override {
    coded = encoder_.encode({counts, 0.001});
    return true;
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    // Into the memory given, like the others.
    const Result<DepthFrame> frame = decoder_.decode(coded, counts.size(), counts);
    if (frame) counts = frame->counts;
    return static_cast<bool>(frame);
  }

 private:
  DhcmEncoder encoder_;
  DhcmDecoder decoder_;
};

}  // namespace

DepthCodecResult make_dhcm(DhcmMode mode) {
  return std::unique_ptr<DepthCodec>(std::make_unique<Dhcm>(mode));
}

}  // namespace rprr
