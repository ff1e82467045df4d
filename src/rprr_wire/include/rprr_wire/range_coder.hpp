// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "rprr_wire/bytes.hpp"

namespace rprr {

/// A binary range coder for small payloads, where tables would cost more than they save: every bit
/// is coded with a probability that follows the bits coded before in its context. Carry propagation
/// as in the LZMA coder; zeros at the end of the payload are not stored.

/// How likely the next bit of a context is a zero; moves by 1/16 of its error, faster at first.
class AdaptiveBit {
 public:
  static constexpr int kBits = 12;

  std::uint32_t split(std::uint32_t range) const { return (range >> kBits) * zero_; }
  void update(bool bit) {
    const int shift = std::min(4, 1 + seen_);
    const int target = bit ? 0 : 1 << kBits;
    zero_ = static_cast<std::uint16_t>(
        std::clamp(zero_ + (target - zero_) / (1 << shift), 32, (1 << kBits) - 32));
    if (seen_ < 3) ++seen_;
  }

 private:
  std::uint16_t zero_ = 1u << (kBits - 1);
  std::uint8_t seen_ = 0;
};

class RangeEncoder {
 public:
  void put(AdaptiveBit& context, bool bit) {
    narrow(context.split(range_), bit);
    context.update(bit);
  }
  /// A bit that is a zero in `zero` of 65536 cases (1 to 65535), by whatever model.
  void put(std::uint32_t zero, bool bit) { narrow((range_ >> 16) * zero, bit); }
  /// The payload; the encoder is done.
  Bytes finish() {
    for (int i = 0; i < 5; ++i) shift_low();
    out_.erase(out_.begin());  // the first byte is always 0
    while (!out_.empty() && out_.back() == 0) out_.pop_back();
    return std::move(out_);
  }

 private:
  static constexpr std::uint32_t kTop = 1u << 24;

  void narrow(std::uint32_t split, bool bit) {
    if (bit) {
      low_ += split;
      range_ -= split;
    } else {
      range_ = split;
    }
    while (range_ < kTop) {
      range_ <<= 8;
      shift_low();
    }
  }
  void shift_low() {
    if (static_cast<std::uint32_t>(low_) < 0xFF000000u || (low_ >> 32) != 0) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      out_.push_back(static_cast<std::uint8_t>(cache_ + carry));
      for (; pending_ > 0; --pending_) out_.push_back(static_cast<std::uint8_t>(0xFF + carry));
      cache_ = static_cast<std::uint8_t>(low_ >> 24);
    } else {
      ++pending_;
    }
    low_ = (low_ & 0x00FFFFFFu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint8_t cache_ = 0;
  std::size_t pending_ = 0;
  Bytes out_;
};

/// Never reads past the payload: bytes that are not there count as the zeros that were trimmed.
class RangeDecoder {
 public:
  explicit RangeDecoder(ByteView bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
  }
  bool get(AdaptiveBit& context) {
    const bool bit = narrow(context.split(range_));
    context.update(bit);
    return bit;
  }
  /// What was put with the same `zero`.
  bool get(std::uint32_t zero) { return narrow((range_ >> 16) * zero); }
  bool read_all() const { return at_ >= bytes_.size; }

 private:
  static constexpr std::uint32_t kTop = 1u << 24;

  bool narrow(std::uint32_t split) {
    const bool bit = code_ >= split;
    if (bit) {
      code_ -= split;
      range_ -= split;
    } else {
      range_ = split;
    }
    while (range_ < kTop) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return bit;
  }
  std::uint32_t next() { return at_ < bytes_.size ? bytes_.data[at_++] : 0u; }

  ByteView bytes_;
  std::size_t at_ = 0;
  std::uint32_t code_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
};

}  // namespace rprr
