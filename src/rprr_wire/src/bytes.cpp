// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/bytes.hpp"

#include <zlib.h>

namespace rprr {

std::uint32_t crc32(ByteView bytes) {
  return static_cast<std::uint32_t>(::crc32_z(::crc32_z(0, nullptr, 0), bytes.data, bytes.size));
}

void seal(Bytes& bytes) {
  const std::uint32_t sum = crc32(bytes);
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
}

ByteView unseal(ByteView bytes) {
  if (bytes.size < 4) return {};
  const ByteView content = bytes.first(bytes.size - 4);
  const auto sum = ByteReader(bytes.from(bytes.size - 4)).get<std::uint32_t>();
  return sum == crc32(content) ? content : ByteView{};
}

}  // namespace rprr
