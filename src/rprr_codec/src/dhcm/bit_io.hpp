// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {

/// Eight bytes, the first one lowest.
inline std::uint64_t load64(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof(value));
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  value = __builtin_bswap64(value);
#endif
  return value;
}

inline void store64(std::uint64_t value, std::uint8_t* bytes) {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  value = __builtin_bswap64(value);
#endif
  std::memcpy(bytes, &value, sizeof(value));
}

/// Appends bits to bytes, the least significant bit of a byte first. Between the first put and
/// finish the vector is longer than what it holds.
class BitWriter {
 public:
  explicit BitWriter(Bytes& out) : out_(out), at_(out.size()) {}

  /// At most 32 bits; those of value above count must be 0.
  void put(std::uint32_t value, int count) {
    accumulator_ |= static_cast<std::uint64_t>(value) << filled_;
    filled_ += count;
    if (filled_ >= 32) flush_word();
  }
  /// Pads the last byte with zeros. Nothing may be put afterwards.
  void finish() {
    out_.resize(at_);
    for (; filled_ > 0; filled_ -= 8) {
      out_.push_back(static_cast<std::uint8_t>(accumulator_));
      accumulator_ >>= 8;
    }
  }

 private:
  static constexpr std::size_t kLeastRoom = 4096;

  void flush_word() {
    if (out_.size() < at_ + 4) out_.resize(2 * at_ + kLeastRoom);
    const std::uint8_t raw[4] = {static_cast<std::uint8_t>(accumulator_),
                                 static_cast<std::uint8_t>(accumulator_ >> 8),
                                 static_cast<std::uint8_t>(accumulator_ >> 16),
                                 static_cast<std::uint8_t>(accumulator_ >> 24)};
    std::memcpy(out_.data() + at_, raw, sizeof(raw));
    at_ += 4;
    accumulator_ >>= 32;
    filled_ -= 32;
  }

  Bytes& out_;
  std::size_t at_;
  std::uint64_t accumulator_ = 0;
  int filled_ = 0;  // bits in the accumulator, below 32 between calls
};

/// Writes bits as BitWriter does, without a branch for each number.
/// Precondition: the caller made room for 8 bytes more than the bits take.
class PlainBitWriter {
 public:
  explicit PlainBitWriter(std::uint8_t* to) : at_(to) {}

  /// At most 56 bits; those of value above count must be 0.
  void put(std::uint64_t value, int count) {
    accumulator_ |= value << filled_;
    filled_ += count;
    store64(accumulator_, at_);
    at_ += filled_ >> 3;
    accumulator_ >>= filled_ & 56;
    filled_ &= 7;
  }
  /// Behind the last byte, which is padded with zeros.
  const std::uint8_t* end() const { return filled_ > 0 ? at_ + 1 : at_; }

 private:
  std::uint8_t* at_;
  std::uint64_t accumulator_ = 0;
  int filled_ = 0;  // bits in the accumulator, below 8 between calls
};

/// Reads what BitWriter wrote. Past the end it reads zeros and remembers that it did, so that inner
/// loops need no check of their own.
class BitReader {
 public:
  BitReader() = default;
  explicit BitReader(ByteView bytes) : at_(bytes.data), end_(bytes.data + bytes.size) {}

  /// Makes at least 56 bits available to peek and skip.
  void refill() {
    if (end_ - at_ >= 8) {
      accumulator_ |= load64(at_) << filled_;
      at_ += (63 - filled_) >> 3;
      filled_ |= 56;
    } else {
      refill_near_end();
    }
  }
  std::uint32_t peek(int count) const {
    return static_cast<std::uint32_t>(accumulator_ & ((std::uint64_t{1} << count) - 1));
  }
  void skip(int count) {
    accumulator_ >>= count;
    filled_ -= count;
  }
  /// Refill, peek and skip at once.
  std::uint32_t get(int count) {
    refill();
    const std::uint32_t value = peek(count);
    skip(count);
    return value;
  }

  /// True once more bits were taken than there are.
  bool overrun() const { return padding_ * 8 > filled_; }
  /// True if what is left is only the padding of the last byte.
  bool finished() const {
    const std::ptrdiff_t left = (end_ - at_) * 8 + filled_ - padding_ * 8;
    return left >= 0 && left < 8;
  }

 private:
  void refill_near_end() {
    for (; filled_ < 56; filled_ += 8) {
      if (at_ < end_) {
        accumulator_ |= static_cast<std::uint64_t>(*at_++) << filled_;
      } else {
        ++padding_;
      }
    }
  }

  const std::uint8_t* at_ = nullptr;
  const std::uint8_t* end_ = nullptr;
  std::uint64_t accumulator_ = 0;
  int filled_ = 0;
  std::ptrdiff_t padding_ = 0;  // zero bytes that were made up past the end
};

}  // namespace rprr::dhcm
