// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_sensor/cameras/frame_pairing.hpp"

#include <utility>

namespace rprr {
namespace {

constexpr std::size_t kMostWaiting = 4;

}  // namespace

std::optional<DevicePair> FramePairing::add(DeviceImage image, Stamp stamp) {
  const bool is_colour = image.kind == DeviceImage::Kind::colour;
  auto& own = is_colour ? colour_ : depth_;
  auto& other = is_colour ? depth_ : colour_;
  if (!own.empty() && stamp <= own.back().stamp) {
    unpaired_ += own.size();
    own.clear();
  }
  while (!other.empty() && other.front().stamp < stamp - window_) {
    other.pop_front();
    ++unpaired_;
  }
  if (!other.empty() && other.front().stamp <= stamp + window_) {
    Waiting partner = std::move(other.front());
    other.pop_front();
    unpaired_ += own.size();  // older than this one, whose partner is older than any to come
    own.clear();
    if (is_colour) {
      return DevicePair{std::move(image), std::move(partner.image), stamp, partner.stamp};
    }
    return DevicePair{std::move(partner.image), std::move(image), partner.stamp, stamp};
  }
  if (own.size() >= kMostWaiting) {
    own.pop_front();
    ++unpaired_;
  }
  own.push_back({std::move(image), stamp});
  return std::nullopt;
}

}  // namespace rprr
