// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/makers.hpp"

#ifdef RPRR_HAVE_JXL
#include <jxl/decode_cxx.h>

#include "codec/peers/jpeg_xl_output.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

constexpr JxlPixelFormat kGrey16 = {1, JXL_TYPE_UINT16, JXL_NATIVE_ENDIAN, 0};

class JpegXl : public DepthCodec {
 public:
  explicit JpegXl(int effort)
      : effort_(effort), encoder_(JxlEncoderMake(nullptr)), decoder_(JxlDecoderMake(nullptr)) {}

  bool encode(const cv::Mat& counts, Bytes& coded) override {
    JxlEncoder* const encoder = encoder_.get();
    JxlEncoderReset(encoder);
    return describe(counts.size()) && add(counts) && drain_jpeg_xl(encoder, buffer_, coded);
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    JxlDecoder* const decoder = decoder_.get();
    JxlDecoderReset(decoder);
    const std::size_t size = counts.total() * counts.elemSize();
    if (JxlDecoderSubscribeEvents(decoder, JXL_DEC_FULL_IMAGE) != JXL_DEC_SUCCESS ||
        JxlDecoderSetInput(decoder, coded.data, coded.size) != JXL_DEC_SUCCESS) {
      return false;
    }
    JxlDecoderCloseInput(decoder);
    if (JxlDecoderProcessInput(decoder) != JXL_DEC_NEED_IMAGE_OUT_BUFFER ||
        JxlDecoderSetImageOutBuffer(decoder, &kGrey16, counts.data, size) != JXL_DEC_SUCCESS) {
      return false;
    }
    return JxlDecoderProcessInput(decoder) == JXL_DEC_FULL_IMAGE;
  }

 private:
  bool describe(cv::Size size) {
    JxlBasicInfo info;
    JxlEncoderInitBasicInfo(&info);
    info.xsize = static_cast<std::uint32_t>(size.width);
    info.ysize = static_cast<std::uint32_t>(size.height);
    info.bits_per_sample = 16;
    info.num_color_channels = 1;
    info.uses_original_profile = JXL_TRUE;  // lossless wants it
    JxlColorEncoding colours;
    JxlColorEncodingSetToSRGB(&colours, JXL_TRUE);
    return JxlEncoderSetBasicInfo(encoder_.get(), &info) == JXL_ENC_SUCCESS &&
           JxlEncoderSetColorEncoding(encoder_.get(), &colours) == JXL_ENC_SUCCESS;
  }

  bool add(const cv::Mat& counts) {
    JxlEncoderFrameSettings* const frame = JxlEncoderFrameSettingsCreate(encoder_.get(), nullptr);
    const std::size_t size = counts.total() * counts.elemSize();
    const bool good =
        JxlEncoderSetFrameLossless(frame, JXL_TRUE) == JXL_ENC_SUCCESS &&
        JxlEncoderFrameSettingsSetOption(frame, JXL_ENC_FRAME_SETTING_EFFORT, effort_) ==
            JXL_ENC_SUCCESS &&
        JxlEncoderAddImageFrame(frame, &kGrey16, counts.data, size) == JXL_ENC_SUCCESS;
    JxlEncoderCloseInput(encoder_.get());
    return good;
  }

  int effort_;
  JxlEncoderPtr encoder_;
  JxlDecoderPtr decoder_;
  Bytes buffer_;
};

}  // namespace

DepthCodecResult make_jpeg_xl(int effort) {
  return std::unique_ptr<DepthCodec>(std::make_unique<JpegXl>(effort));
}

}  // namespace rprr
#else
namespace rprr {
DepthCodecResult make_jpeg_xl(int) {
  return Error{"libjxl was not built in: install libjxl-dev and build again"};
}
}  // namespace rprr
#endif
