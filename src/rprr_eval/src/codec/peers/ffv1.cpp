// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/makers.hpp"
#include "rprr_wire/bytes.hpp"

#ifdef RPRR_HAVE_AVCODEC
#include <cstring>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace rprr {
namespace {

struct FreeContext {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
using Context = std::unique_ptr<AVCodecContext, FreeContext>;

// The stream's header (some 40 bytes) goes from encoder to decoder beside the frames, as a file's
// container carries it once; it is not counted.
class Ffv1 : public DepthCodec {
 public:
  bool encode(const cv::Mat& counts, Bytes& coded) override {
    if (!open(counts.size())) return false;
    frame_.reset(av_frame_alloc());
    frame_->format = AV_PIX_FMT_GRAY16LE;
    frame_->width = counts.cols;
    frame_->height = counts.rows;
    frame_->pts = next_++;
    if (av_frame_get_buffer(frame_.get(), 0) < 0) return false;
    for (int v = 0; v < counts.rows; ++v) {
      std::memcpy(frame_->data[0] + v * frame_->linesize[0], counts.ptr(v),
                  static_cast<std::size_t>(counts.cols) * 2);
    }
    if (avcodec_send_frame(encoder_.get(), frame_.get()) < 0 ||
        avcodec_receive_packet(encoder_.get(), packet_.get()) < 0) {
      return false;
    }
    coded.assign(packet_->data, packet_->data + packet_->size);
    av_packet_unref(packet_.get());
    return true;
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    // libavcodec reads a little beyond the end of what it is given.
    padded_.assign(coded.data, coded.data + coded.size);
    padded_.resize(coded.size + AV_INPUT_BUFFER_PADDING_SIZE);
    packet_->data = padded_.data();
    packet_->size = static_cast<int>(coded.size);
    frame_.reset(av_frame_alloc());
    const bool good = decoder_ && avcodec_send_packet(decoder_.get(), packet_.get()) >= 0 &&
                      avcodec_receive_frame(decoder_.get(), frame_.get()) >= 0 &&
                      frame_->width == counts.cols && frame_->height == counts.rows;
    av_packet_unref(packet_.get());
    for (int v = 0; good && v < counts.rows; ++v) {
      std::memcpy(counts.ptr(v), frame_->data[0] + v * frame_->linesize[0],
                  static_cast<std::size_t>(counts.cols) * 2);
    }
    return good;
  }

 private:
  static Context context(const AVCodec* codec, cv::Size size) {
    Context made(codec == nullptr ? nullptr : avcodec_alloc_context3(codec));
    if (!made) return made;
    made->width = size.width;
    made->height = size.height;
    made->pix_fmt = AV_PIX_FMT_GRAY16LE;
    made->time_base = {1, 30};
    made->thread_count = 1;
    made->level = 3;
    made->gop_size = 1;
    return made;
  }

  bool open(cv::Size size) {
    if (encoder_ && size == size_) return true;
    size_ = size;
    const AVCodec* const encoder = avcodec_find_encoder(AV_CODEC_ID_FFV1);
    const AVCodec* const decoder = avcodec_find_decoder(AV_CODEC_ID_FFV1);
    encoder_ = context(encoder, size);
    decoder_ = context(decoder, size);
    if (!encoder_ || !decoder_ || avcodec_open2(encoder_.get(), encoder, nullptr) < 0) return false;
    const auto extra = static_cast<std::size_t>(encoder_->extradata_size);
    decoder_->extradata =
        static_cast<std::uint8_t*>(av_mallocz(extra + AV_INPUT_BUFFER_PADDING_SIZE));
    if (extra > 0) std::memcpy(decoder_->extradata, encoder_->extradata, extra);
    decoder_->extradata_size = encoder_->extradata_size;
    return avcodec_open2(decoder_.get(), decoder, nullptr) >= 0;
  }

  cv::Size size_;
  std::int64_t next_ = 0;
  Context encoder_;
  Context decoder_;
  std::unique_ptr<AVFrame, FreeFrame> frame_;
  std::unique_ptr<AVPacket, FreePacket> packet_{av_packet_alloc()};
  Bytes padded_;
};

}  // namespace

DepthCodecResult make_ffv1() {
  av_log_set_level(AV_LOG_ERROR);
  return std::unique_ptr<DepthCodec>(std::make_unique<Ffv1>());
}

}  // namespace rprr
#else
namespace rprr {
DepthCodecResult make_ffv1() {
  return Error{"libavcodec was not built in: install libavcodec-dev and build again"};
}
}  // namespace rprr
#endif
