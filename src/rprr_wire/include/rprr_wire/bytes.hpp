// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace rprr {

using Bytes = std::vector<std::uint8_t>;

/// Bytes owned by somebody else, which must outlive the view.
struct ByteView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;

  ByteView() = default;
  ByteView(const std::uint8_t* bytes, std::size_t count) : data(bytes), size(count) {}
  ByteView(const Bytes& bytes) : data(bytes.data()), size(bytes.size()) {}  // NOLINT: implicit

  ByteView first(std::size_t count) const { return {data, count}; }
  ByteView from(std::size_t offset) const { return {data + offset, size - offset}; }
};

/// Appends little-endian values to a byte vector.
class ByteWriter {
 public:
  ByteWriter() { bytes_.reserve(64); }

  template <typename T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>, "numbers only");
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
#endif
    bytes_.insert(bytes_.end(), raw, raw + sizeof(T));
  }
  void append(ByteView view) {
    bytes_.insert(bytes_.end(), view.data, view.data + view.size);
  }

  std::size_t size() const {
    return bytes_.size();
  }
  Bytes& bytes() {
    return bytes_;
  }
  Bytes take() {
    return std::move(bytes_);
  }

 private:
  Bytes bytes_;
};

/// Reads little-endian values and never past the end: after the first read that does not fit, ok()
/// is false and every value read is zero.
class ByteReader {
 public:
  explicit ByteReader(ByteView view) : view_(view) {}

  template <typename T>
  T get() {
    static_assert(std::is_arithmetic_v<T>, "numbers only");
    T value{};
    if (!claim(sizeof(T))) return value;
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, view_.data + at_ - sizeof(T), sizeof(T));
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
#endif
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }
  /// A view of the next count bytes; empty if they are not there.
  ByteView get_view(std::size_t count) {
    if (!claim(count)) return {};
    return {view_.data + at_ - count, count};
  }

  bool ok() const {
    return ok_;
  }
  std::size_t left() const {
    return view_.size - at_;
  }

 private:
  bool claim(std::size_t count) {
    ok_ = ok_ && count <= left();
    if (ok_) at_ += count;
    return ok_;
  }

  ByteView view_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// CRC-32 (IEEE 802.3), as zlib computes it.
std::uint32_t crc32(ByteView bytes);

/// Appends the CRC-32 of all bytes so far, little-endian.
void seal(Bytes& bytes);

/// The bytes before a trailing CRC-32 that matches them; an empty view if it does not. A checksum
/// finds accidents, not attacks: what it covers is still untrusted.
ByteView unseal(ByteView bytes);

/// Bytes that ROS serialisation adds around the fields of a message (roscpp, wiki.ros.org/msg):
/// a Header is 16 bytes and its frame id, a string or uint8[] is 4 bytes and its content.
constexpr std::size_t ros_header_bytes(std::size_t frame_id_length) {
  return 16 + frame_id_length;
}
constexpr std::size_t ros_array_bytes(std::size_t length) {
  return 4 + length;
}

}  // namespace rprr
