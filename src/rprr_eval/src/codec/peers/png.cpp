// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/imgcodecs.hpp>

#include "codec/peers/makers.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

class Png : public DepthCodec {
 public:
  explicit Png(int level) : level_(level) {}

  bool encode(const cv::Mat& counts, Bytes& coded) override {
    return cv::imencode(".png", counts, coded, {cv::IMWRITE_PNG_COMPRESSION, level_});
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    const cv::Mat bytes(1, static_cast<int>(coded.size), CV_8UC1,
                        const_cast<std::uint8_t*>(coded.data));  // read only
    const cv::Size size = counts.size();
    cv::imdecode(bytes, cv::IMREAD_UNCHANGED, &counts);
    return counts.size() == size;
  }

 private:
  int level_;
};

}  // namespace

DepthCodecResult make_png(int level) {
  return std::unique_ptr<DepthCodec>(std::make_unique<Png>(level));
}

}  // namespace rprr
