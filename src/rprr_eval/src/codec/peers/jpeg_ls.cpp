// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/makers.hpp"
#include "rprr_wire/bytes.hpp"

#ifdef RPRR_HAVE_CHARLS
#include <charls/charls.h>

namespace rprr {
namespace {

class JpegLs : public DepthCodec {
 public:
  bool encode(const cv::Mat& counts, Bytes& coded) override try {
    charls::jpegls_encoder encoder;
    encoder.frame_info(
        {static_cast<std::uint32_t>(counts.cols), static_cast<std::uint32_t>(counts.rows), 16, 1});
    buffer_.resize(encoder.estimated_destination_size());
    encoder.destination(buffer_);
    const std::size_t size =
        encoder.encode(counts.ptr<std::uint16_t>(), counts.total() * counts.elemSize());
    coded.assign(buffer_.data(), buffer_.data() + size);
    return true;
  } catch (const charls::jpegls_error&) {
    return false;
  }

  bool decode(ByteView coded, cv::Mat& counts) override try {
    charls::jpegls_decoder decoder;
    decoder.source(coded.data, coded.size).read_header();
    decoder.decode(counts.ptr<std::uint16_t>(), counts.total() * counts.elemSize());
    return true;
  } catch (const charls::jpegls_error&) {
    return false;
  }

 private:
  Bytes buffer_;
};

}  // namespace

DepthCodecResult make_jpeg_ls() {
  return std::unique_ptr<DepthCodec>(std::make_unique<JpegLs>());
}

}  // namespace rprr
#else
namespace rprr {
DepthCodecResult make_jpeg_ls() {
  return Error{"CharLS was not built in: install libcharls-dev and build again"};
}
}  // namespace rprr
#endif
