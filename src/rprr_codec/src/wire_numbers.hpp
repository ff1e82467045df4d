// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Small numbers in few bytes: seven bits each, the lowest first, bit 7 says that more follow.
inline void put_varint(ByteWriter& writer, std::uint32_t value) {
  for (; value >= 0x80; value >>= 7) writer.put(static_cast<std::uint8_t>(value | 0x80));
  writer.put(static_cast<std::uint8_t>(value));
}

/// False where it is cut short or beyond 32 bits.
inline bool get_varint(ByteReader& reader, std::uint32_t& value) {
  std::uint64_t sum = 0;
  for (int shift = 0; shift < 35; shift += 7) {
    const auto byte = reader.get<std::uint8_t>();
    sum |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
    if ((byte & 0x80) != 0) continue;
    value = static_cast<std::uint32_t>(sum);
    return reader.ok() && sum <= std::numeric_limits<std::uint32_t>::max();
  }
  return false;
}

/// The lowest 48 bits of a number within +-2^47.
inline void put_int48(ByteWriter& writer, std::int64_t value) {
  writer.put(static_cast<std::uint32_t>(value));
  writer.put(static_cast<std::uint16_t>(value >> 32));
}

inline std::int64_t get_int48(ByteReader& reader) {
  const auto low = reader.get<std::uint32_t>();
  const auto high = reader.get<std::int16_t>();
  return static_cast<std::int64_t>(high) * (std::int64_t{1} << 32) + low;
}

}  // namespace rprr
