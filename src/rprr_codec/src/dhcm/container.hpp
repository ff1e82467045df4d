// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "rprr_codec/dhcm.hpp"
#include "rprr_geometry/result.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {

/// How the pixels are written.
enum class Body : std::uint8_t { kStored = 0, kEvents = 1, kStrips = 2 };

/// What stands before the pixels (doc/dhcm.md).
struct Header {
  Body body = Body::kEvents;
  DhcmMode mode = DhcmMode::kDefault;
  DhcmPixels pixels = DhcmPixels::kCounts;
  bool masked = false;  // only the blocks of a mask, which is not in the payload
  int width = 0;
  int height = 0;
  double unit = 0.001;
};

constexpr int kVersion = 3;
/// An encoder stores a body that is longer by more than this than the pixels as they are.
constexpr std::size_t kStoredGain = 14;
/// Bytes of the longest header and the checksum.
constexpr std::size_t kMostAround = 18 + 4;

/// Writes the header with room for the length of the body, which is appended by the caller.
void begin(const Header& header, Bytes& out);
/// Fills in the body's length and seals the payload.
void finish(Bytes& out);

struct Opened {
  Header header;
  ByteView body;
};
/// Checks seal, version, sizes and lengths.
Result<Opened> open(ByteView payload);

}  // namespace rprr::dhcm
