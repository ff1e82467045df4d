// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rprr_geometry/camera.hpp"
#include "rprr_pose/icp_bd.hpp"
#include "rprr_pose/samples_wire.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {

/// Intrinsics cross the radio once and are named by their hash afterwards: who knows what.
class PeerCameras {
 public:
  /// Takes in what the peer's message says.
  void learn(const SamplesContent& content) {
    if (content.camera) peer_ = *content.camera;
    known_at_peer_ = content.known_peer_hash;
  }
  /// The peer's camera of that hash, if it is known here.
  std::optional<Camera> find(std::uint32_t hash) const {
    if (peer_ && camera_hash(*peer_) == hash) return peer_;
    return std::nullopt;
  }
  /// Writes what a message to the peer has to say of cameras.
  void describe(const Camera& own, SamplesContent& content) const {
    content.camera_hash = camera_hash(own);
    content.known_peer_hash = peer_ ? camera_hash(*peer_) : 0;
    if (known_at_peer_ != content.camera_hash) content.camera = own;
  }
  bool known_at_peer(const Camera& own) const { return known_at_peer_ == camera_hash(own); }

 private:
  std::optional<Camera> peer_;
  std::uint32_t known_at_peer_ = 0;
};

/// The points of a message as a surface of that camera, or nothing if some lie outside its image.
inline std::optional<SampledSurface> surface_of(SamplesContent& content, const Camera& camera) {
  for (const SamplePoint& point : content.points) {
    if (point.column >= camera.width || point.row >= camera.height) return std::nullopt;
  }
  return SampledSurface{camera, content.unit, std::move(content.points)};
}

}  // namespace rprr
