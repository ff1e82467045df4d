// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>

#include "rprr_geometry/wire.hpp"

namespace rprr::fuzz {

/// Larger images only make a fuzzer slow.
constexpr std::size_t kMaxPixels = 1 << 16;

inline void require(bool condition) {
  if (!condition) std::abort();
}

/// The bytes as a depth payload whose version, length of the body and checksum are right.
inline Bytes made_good(ByteView view) {
  if (view.size < 18) return {};
  Bytes bytes(view.data, view.data + view.size);
  bytes[0] = 2;
  const std::size_t head = (bytes[1] & 8) != 0 ? 18 : 14;
  const std::size_t body = bytes.size() - head;
  for (std::size_t i = 0; i < 4; ++i) bytes[6 + i] = static_cast<std::uint8_t>(body >> (8 * i));
  seal(bytes);
  return bytes;
}

}  // namespace rprr::fuzz
