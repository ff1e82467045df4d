// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/makers.hpp"

#ifdef RPRR_HAVE_JXL
#include <jxl/decode_cxx.h>

#include <opencv2/imgproc.hpp>

#include "codec/peers/jpeg_xl_output.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr JxlPixelFormat kRgb8 = {3, JXL_TYPE_UINT8, JXL_NATIVE_ENDIAN, 0};
constexpr std::size_t kSeal = 4;  // bytes of checksum that every payload of ours carries

class JpegXlColour : public WholeColour {
 public:
  explicit JpegXlColour(int effort)
      : effort_(effort), encoder_(JxlEncoderMake(nullptr)), decoder_(JxlDecoderMake(nullptr)) {}

  std::string name() const override { return "jxl"; }
  std::vector<double> settings() const override {
    return {25, 18, 13, 9.5, 7, 5, 3.6, 2.6, 1.8, 1.2, 0.7, 0.3};
  }

  Result<Bytes> encode(const cv::Mat& bgr, double distance) override {
    cv::cvtColor(bgr, rgb_, cv::COLOR_BGR2RGB);
    JxlEncoderReset(encoder_.get());
    Bytes coded;
    if (!describe(bgr.size()) || !add(static_cast<float>(distance)) ||
        !drain_jpeg_xl(encoder_.get(), buffer_, coded)) {
      return Error{"libjxl did not encode at distance " + std::to_string(distance)};
    }
    coded.resize(coded.size() + kSeal);
    return coded;
  }

  Result<cv::Mat> decode(ByteView payload, cv::Size size) override {
    JxlDecoder* const decoder = decoder_.get();
    JxlDecoderReset(decoder);
    rgb_.create(size, CV_8UC3);
    const bool begun =
        JxlDecoderSubscribeEvents(decoder, JXL_DEC_FULL_IMAGE) == JXL_DEC_SUCCESS &&
        JxlDecoderSetInput(decoder, payload.data, payload.size - kSeal) == JXL_DEC_SUCCESS;
    JxlDecoderCloseInput(decoder);
    if (!begun || JxlDecoderProcessInput(decoder) != JXL_DEC_NEED_IMAGE_OUT_BUFFER ||
        JxlDecoderSetImageOutBuffer(decoder, &kRgb8, rgb_.data, rgb_.total() * rgb_.elemSize()) !=
            JXL_DEC_SUCCESS ||
        JxlDecoderProcessInput(decoder) != JXL_DEC_FULL_IMAGE) {
      return Error{"libjxl did not decode its own payload"};
    }
    cv::Mat bgr;
    cv::cvtColor(rgb_, bgr, cv::COLOR_RGB2BGR);
    return bgr;
  }

 private:
  bool describe(cv::Size size) {
    JxlBasicInfo info;
    JxlEncoderInitBasicInfo(&info);
    info.xsize = static_cast<std::uint32_t>(size.width);
    info.ysize = static_cast<std::uint32_t>(size.height);
    info.bits_per_sample = 8;
    info.num_color_channels = 3;
    info.uses_original_profile = JXL_FALSE;  // lossy: XYB
    JxlColorEncoding colours;
    JxlColorEncodingSetToSRGB(&colours, JXL_FALSE);
    return JxlEncoderSetBasicInfo(encoder_.get(), &info) == JXL_ENC_SUCCESS &&
           JxlEncoderSetColorEncoding(encoder_.get(), &colours) == JXL_ENC_SUCCESS;
  }

  bool add(float distance) {
    JxlEncoderFrameSettings* const frame = JxlEncoderFrameSettingsCreate(encoder_.get(), nullptr);
    const bool good = JxlEncoderSetFrameDistance(frame, distance) == JXL_ENC_SUCCESS &&
                      JxlEncoderFrameSettingsSetOption(frame, JXL_ENC_FRAME_SETTING_EFFORT,
                                                       effort_) == JXL_ENC_SUCCESS &&
                      JxlEncoderAddImageFrame(frame, &kRgb8, rgb_.data,
                                              rgb_.total() * rgb_.elemSize()) == JXL_ENC_SUCCESS;
    JxlEncoderCloseInput(encoder_.get());
    return good;
  }

  int effort_;
  JxlEncoderPtr encoder_;
  JxlDecoderPtr decoder_;
  cv::Mat rgb_;
  Bytes buffer_;
};

}  // namespace

std::unique_ptr<WholeColour> make_jpeg_xl_colour(int effort) {
  return std::make_unique<JpegXlColour>(effort);
}

}  // namespace rprr
#else
namespace rprr {
std::unique_ptr<WholeColour> make_jpeg_xl_colour(int) {
  return nullptr;
}
}  // namespace rprr
#endif
