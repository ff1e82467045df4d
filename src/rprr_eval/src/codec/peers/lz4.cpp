// SPDX-License-Identifier: BSD-3-Clause
#include "codec/peers/makers.hpp"
#include "codec/peers/row_deltas.hpp"
#include "rprr_wire/bytes.hpp"

#ifdef RPRR_HAVE_LZ4
#include <lz4.h>

namespace rprr {
namespace {

class Lz4 : public DepthCodec {
 public:
  bool encode(const cv::Mat& counts, Bytes& coded) override {
    split_row_deltas(counts, planes_);
    const int size = static_cast<int>(planes_.size());
    buffer_.resize(static_cast<std::size_t>(LZ4_compressBound(size)));
    const int written = LZ4_compress_default(reinterpret_cast<const char*>(planes_.data()),
                                             reinterpret_cast<char*>(buffer_.data()), size,
                                             static_cast<int>(buffer_.size()));
    coded.assign(buffer_.data(), buffer_.data() + written);
    return written > 0;
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    planes_.resize(2 * counts.total());
    const int size = static_cast<int>(planes_.size());
    const int written = LZ4_decompress_safe(reinterpret_cast<const char*>(coded.data),
                                            reinterpret_cast<char*>(planes_.data()),
                                            static_cast<int>(coded.size), size);
    if (written != size) return false;
    join_row_deltas(planes_, counts);
    return true;
  }

 private:
  Bytes planes_;
  Bytes buffer_;
};

}  // namespace

DepthCodecResult make_lz4() {
  return std::unique_ptr<DepthCodec>(std::make_unique<Lz4>());
}

}  // namespace rprr
#else
namespace rprr {
DepthCodecResult make_lz4() {
  return Error{"LZ4 was not built in: install liblz4-dev and build again"};
}
}  // namespace rprr
#endif
