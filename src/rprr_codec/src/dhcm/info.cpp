// SPDX-License-Identifier: BSD-3-Clause
#include "dhcm/container.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

Result<DhcmMode> dhcm_mode_from_name(const std::string& name) {
  for (const DhcmMode mode : {DhcmMode::kFast, DhcmMode::kDefault, DhcmMode::kSmall}) {
    if (name == dhcm_mode_name(mode)) return mode;
  }
  return Error{"no such mode of DHC-M: " + name + " (fast, default or small)"};
}

const char* dhcm_mode_name(DhcmMode mode) {
  switch (mode) {
    case DhcmMode::kFast:
      return "fast";
    case DhcmMode::kSmall:
      return "small";
    default:
      return "default";
  }
}

Result<DhcmInfo> dhcm_info(ByteView payload) {
  const Result<dhcm::Opened> opened = dhcm::open(payload);
  if (!opened) return Error{opened.reason()};
  const dhcm::Header& header = opened->header;
  DhcmInfo info;
  info.version = dhcm::kVersion;
  info.mode = header.mode;
  info.pixels = header.pixels;
  info.masked = header.masked;
  info.stored = header.body == dhcm::Body::kStored;
  info.width = header.width;
  info.height = header.height;
  info.unit = header.unit;
  return info;
}

std::size_t dhcm_bound(cv::Size size, DhcmPixels pixels) {
  // An encoder stores what would come out longer than this.
  constexpr std::size_t kOverhead = 36;
  const std::size_t counts =
      2 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) + kOverhead;
  // Two of them, in a payload of their own.
  return pixels == DhcmPixels::kFloat ? 2 * counts + kOverhead : counts;
}

}  // namespace rprr
