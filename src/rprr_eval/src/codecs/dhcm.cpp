// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_codec/dhcm.hpp"

#include "codecs/makers.hpp"

namespace rprr {
namespace {

class Dhcm : public DepthCodec {
 public:
  bool encode(const cv::Mat& counts, Bytes& coded) override {
    coded = encoder_.encode({counts, 0.001});
    return true;
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    Result<DepthFrame> frame = decoder_.decode(coded, counts.size());
    if (frame) counts = frame->counts;
    return static_cast<bool>(frame);
  }

 private:
  DhcmEncoder encoder_;
  DhcmDecoder decoder_;
};

}  // namespace

DepthCodecResult make_dhcm() {
  return std::unique_ptr<DepthCodec>(std::make_unique<Dhcm>());
}

}  // namespace rprr
