// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/makers.hpp"
#include "codec/peers/row_deltas.hpp"
#include "rprr_wire/bytes.hpp"

#ifdef RPRR_HAVE_ZSTD
#include <zstd.h>

namespace rprr {
namespace {

class Zstd : public DepthCodec {
 public:
  explicit Zstd(int level)
      : level_(level),
        compress_(ZSTD_createCCtx(), ZSTD_freeCCtx),
        decompress_(ZSTD_createDCtx(), ZSTD_freeDCtx) {}

  bool encode(const cv::Mat& counts, Bytes& coded) override {
    split_row_deltas(counts, planes_);
    buffer_.resize(ZSTD_compressBound(planes_.size()));
    const std::size_t size = ZSTD_compressCCtx(compress_.get(), buffer_.data(), buffer_.size(),
                                               planes_.data(), planes_.size(), level_);
    if (ZSTD_isError(size)) return false;
    coded.assign(buffer_.data(), buffer_.data() + size);
    return true;
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    planes_.resize(2 * counts.total());
    const std::size_t size = ZSTD_decompressDCtx(decompress_.get(), planes_.data(), planes_.size(),
                                                 coded.data, coded.size);
    if (size != planes_.size()) return false;
    join_row_deltas(planes_, counts);
    return true;
  }

 private:
  int level_;
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> compress_;
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> decompress_;
  Bytes planes_;
  Bytes buffer_;
};

}  // namespace

DepthCodecResult make_zstd(int level) {
  return std::unique_ptr<DepthCodec>(std::make_unique<Zstd>(level));
}

}  // namespace rprr
#else
namespace rprr {
DepthCodecResult make_zstd(int) {
  return Error{"Zstandard was not built in: install libzstd-dev and build again"};
}
}  // namespace rprr
#endif
