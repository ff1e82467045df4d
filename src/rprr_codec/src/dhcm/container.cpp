// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/container.hpp"

#include <cmath>

#include "rprr_geometry/camera.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr::dhcm {
namespace {

constexpr std::uint8_t kBodyBits = 0x03;
constexpr std::uint8_t kMasked = 0x04;
constexpr std::uint8_t kPlainUnit = 0x08;  // f64 metres per count; else f32 counts per metre
constexpr int kPixelsShift = 4;
constexpr int kModeShift = 6;
constexpr std::size_t kLengthAt = 6;

}  // namespace

void begin(const Header& header, Bytes& out) {
  // Sensors count in whole parts of a metre: 1000, 5000.
  const auto per_metre = static_cast<float>(1.0 / header.unit);
  const bool plain = 1.0 / static_cast<double>(per_metre) != header.unit;
  ByteWriter writer;
  writer.put(static_cast<std::uint8_t>(kVersion));
  writer.put(static_cast<std::uint8_t>(static_cast<int>(header.body) |
                                       static_cast<int>(header.pixels) << kPixelsShift |
                                       static_cast<int>(header.mode) << kModeShift |
                                       (header.masked ? kMasked : 0) | (plain ? kPlainUnit : 0)));
  writer.put(static_cast<std::uint16_t>(header.width));
  writer.put(static_cast<std::uint16_t>(header.height));
  writer.put(std::uint32_t{0});
  if (plain) {
    writer.put(header.unit);
  } else {
    writer.put(per_metre);
  }
  out = writer.take();
}

void finish(Bytes& out) {
  const std::size_t head = kLengthAt + 4 + ((out[1] & kPlainUnit) != 0 ? 8 : 4);
  const std::size_t body = out.size() - head;
  for (std::size_t i = 0; i < 4; ++i) {
    out[kLengthAt + i] = static_cast<std::uint8_t>(body >> (8 * i));
  }
  seal(out);
}

Result<Opened> open(ByteView payload) {
  ByteReader reader(unseal(payload));
  const auto version = reader.get<std::uint8_t>();
  const auto flags = reader.get<std::uint8_t>();
  Opened opened;
  opened.header.width = reader.get<std::uint16_t>();
  opened.header.height = reader.get<std::uint16_t>();
  const auto length = reader.get<std::uint32_t>();
  opened.header.unit = (flags & kPlainUnit) != 0 ? reader.get<double>()
                                                 : 1.0 / static_cast<double>(reader.get<float>());
  if (!reader.ok()) return Error{"depth payload damaged or cut short"};
  if (version != kVersion) return Error{"depth payload of an unknown version"};
  const int body = flags & kBodyBits;
  const int pixels = flags >> kPixelsShift & 3;
  const int mode = flags >> kModeShift & 3;
  if (body > 2 || pixels > 2 || mode > 2) return Error{"depth payload in an unknown mode"};
  opened.header.body = static_cast<Body>(body);
  opened.header.pixels = static_cast<DhcmPixels>(pixels);
  opened.header.mode = static_cast<DhcmMode>(mode);
  opened.header.masked = (flags & kMasked) != 0;
  const Header& header = opened.header;
  if (header.width < 1 || header.height < 1 || header.width > kMaxImageSide ||
      header.height > kMaxImageSide) {
    return Error{"depth payload states an impossible image size"};
  }
  if (!std::isfinite(header.unit) || !(header.unit > 0.0)) {
    return Error{"depth payload states an impossible unit"};
  }
  if (length != reader.left()) return Error{"depth payload of another length than stated"};
  opened.body = reader.get_view(length);
  return opened;
}

}  // namespace rprr::dhcm
