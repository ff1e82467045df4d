// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>

#include "rprr_wire/bytes.hpp"

namespace rprr::fuzz {

/// The version of the depth format, and the kind of body that has streams (rprr_codec/doc/dhcm.md).
constexpr std::uint8_t kVersion = 3;
constexpr int kStrips = 2;

/// Larger images only make a fuzzer slow.
constexpr std::size_t kMaxPixels = 1 << 16;

inline void require(bool condition) {
  if (!condition) std::abort();
}

/// Makes the lengths of four streams fit into a body of strips; those that do stay.
inline void make_streams_fit(std::uint8_t* body, std::size_t size) {
  std::size_t left = size - 16;
  for (std::uint8_t* at = body; at < body + 16; at += 4) {
    const std::size_t stated =
        at[0] | at[1] << 8 | at[2] << 16 | static_cast<std::size_t>(at[3]) << 24;
    const std::size_t length = stated % (left + 1);
    left -= length;
    for (std::size_t i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(length >> (8 * i));
  }
}

/// The bytes as a depth payload whose version, lengths and checksum are right.
inline Bytes made_good(ByteView view) {
  if (view.size < 18) return {};
  Bytes bytes(view.data, view.data + view.size);
  bytes[0] = kVersion;
  const std::size_t head = (bytes[1] & 8) != 0 ? 18 : 14;
  const std::size_t body = bytes.size() - head;
  for (std::size_t i = 0; i < 4; ++i) bytes[6 + i] = static_cast<std::uint8_t>(body >> (8 * i));
  const bool strips = (bytes[1] & 3) == kStrips;
  if (strips && body >= 16) make_streams_fit(bytes.data() + head, body);
  seal(bytes);
  return bytes;
}

}  // namespace rprr::fuzz
