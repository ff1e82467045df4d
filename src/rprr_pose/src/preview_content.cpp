// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/preview_protocol.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kHasCamera = 1;

}  // namespace

Bytes encode_preview_content(const PreviewContent& content) {
  ByteWriter writer;
  writer.put(kVersion);
  writer.put(static_cast<std::uint8_t>(content.camera ? kHasCamera : 0));
  writer.put(content.camera_hash);
  writer.put(content.known_peer_hash);
  if (content.camera) put_camera(writer, *content.camera);
  writer.append(content.preview);
  return writer.take();
}

Result<PreviewContent> decode_preview_content(ByteView bytes) {
  ByteReader reader(bytes);
  const auto version = reader.get<std::uint8_t>();
  const auto flags = reader.get<std::uint8_t>();
  PreviewContent content;
  content.camera_hash = reader.get<std::uint32_t>();
  content.known_peer_hash = reader.get<std::uint32_t>();
  if (!reader.ok()) return Error{"preview message cut short"};
  if (version != kVersion) return Error{"preview message of an unknown version"};
  if ((flags & ~kHasCamera) != 0) return Error{"preview message with unknown flags"};
  if ((flags & kHasCamera) != 0) {
    const Result<Camera> camera = get_camera(reader);
    if (!camera) return Error{"preview message: " + camera.reason()};
    if (camera_hash(*camera) != content.camera_hash) {
      return Error{"preview message: camera and hash differ"};
    }
    content.camera = *camera;
  }
  const ByteView preview = reader.get_view(reader.left());
  content.preview.assign(preview.data, preview.data + preview.size);
  return content;
}

}  // namespace rprr
