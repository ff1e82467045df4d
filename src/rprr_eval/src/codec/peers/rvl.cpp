// SPDX-License-Identifier: BSD-3-Clause
// RVL as the paper's listing has it: runs of zeros and of others in turn, differences folded to
// non-negative numbers, all of them as nibbles of three bits and one that says whether more follow.
#include <cstring>

#include "codec/peers/makers.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

class NibbleWriter {
 public:
  explicit NibbleWriter(std::uint32_t* out) : begin_(out), at_(out) {}

  void put(std::uint32_t value) {
    do {
      std::uint32_t nibble = value & 0x7;
      if (value >>= 3) nibble |= 0x8;
      word_ = word_ << 4 | nibble;
      if (++nibbles_ == 8) {
        *at_++ = word_;
        nibbles_ = 0;
        word_ = 0;
      }
    } while (value != 0);
  }
  std::size_t finish() {
    if (nibbles_ != 0) *at_++ = word_ << 4 * (8 - nibbles_);
    return static_cast<std::size_t>(at_ - begin_);
  }

 private:
  std::uint32_t* begin_;
  std::uint32_t* at_;
  std::uint32_t word_ = 0;
  int nibbles_ = 0;
};

class NibbleReader {
 public:
  explicit NibbleReader(const std::uint32_t* in) : at_(in) {}

  std::uint32_t get() {
    std::uint32_t value = 0;
    std::uint32_t nibble = 0;
    int bits = 29;
    do {
      if (nibbles_ == 0) {
        word_ = *at_++;
        nibbles_ = 8;
      }
      nibble = word_ & 0xf0000000u;
      value |= (nibble << 1) >> bits;
      word_ <<= 4;
      --nibbles_;
      bits -= 3;
    } while (nibble & 0x80000000u);
    return value;
  }

 private:
  const std::uint32_t* at_;
  std::uint32_t word_ = 0;
  int nibbles_ = 0;
};

std::size_t compress(const std::uint16_t* input, std::size_t pixels, std::uint32_t* output) {
  NibbleWriter writer(output);
  const std::uint16_t* const end = input + pixels;
  std::int32_t previous = 0;
  while (input != end) {
    const std::uint16_t* start = input;
    while (input != end && *input == 0) ++input;
    writer.put(static_cast<std::uint32_t>(input - start));
    start = input;
    while (input != end && *input != 0) ++input;
    writer.put(static_cast<std::uint32_t>(input - start));
    for (const std::uint16_t* p = start; p != input; ++p) {
      const std::int32_t delta = *p - previous;
      writer.put(static_cast<std::uint32_t>(delta) << 1 ^ static_cast<std::uint32_t>(delta >> 31));
      previous = *p;
    }
  }
  return writer.finish();
}

void decompress(const std::uint32_t* input, std::uint16_t* output, std::size_t pixels) {
  NibbleReader reader(input);
  std::int32_t current = 0;
  while (pixels != 0) {
    const std::uint32_t zeros = reader.get();
    pixels -= zeros;
    for (std::uint32_t i = 0; i < zeros; ++i) *output++ = 0;
    const std::uint32_t others = reader.get();
    pixels -= others;
    for (std::uint32_t i = 0; i < others; ++i) {
      const std::uint32_t folded = reader.get();
      current += static_cast<std::int32_t>(folded >> 1) ^ -static_cast<std::int32_t>(folded & 1);
      *output++ = static_cast<std::uint16_t>(current);
    }
  }
}

class Rvl : public DepthCodec {
 public:
  bool encode(const cv::Mat& counts, Bytes& coded) override {
    // Six nibbles a difference and at most two for its share of the runs.
    words_.resize(counts.total() + 4);
    const std::size_t words = compress(counts.ptr<std::uint16_t>(), counts.total(), words_.data());
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(words_.data());
    coded.assign(bytes, bytes + words * sizeof(std::uint32_t));
    return true;
  }

  bool decode(ByteView coded, cv::Mat& counts) override {
    words_.resize(coded.size / sizeof(std::uint32_t) + 1);
    std::memcpy(words_.data(), coded.data, coded.size);
    decompress(words_.data(), counts.ptr<std::uint16_t>(), counts.total());
    return true;
  }

 private:
  std::vector<std::uint32_t> words_;
};

}  // namespace

DepthCodecResult make_rvl() {
  return std::unique_ptr<DepthCodec>(std::make_unique<Rvl>());
}

}  // namespace rprr
