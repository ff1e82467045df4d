// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_wire/camera_wire.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

void put_camera(ByteWriter& writer, const Camera& camera) {
  writer.put(static_cast<std::uint16_t>(camera.width));
  writer.put(static_cast<std::uint16_t>(camera.height));
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) {
    writer.put(static_cast<float>(value));
  }
}

Result<Camera> get_camera(ByteReader& reader) {
  Camera camera;
  camera.width = reader.get<std::uint16_t>();
  camera.height = reader.get<std::uint16_t>();
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) {
    *value = static_cast<double>(reader.get<float>());
  }
  if (!reader.ok()) return Error{"camera cut short"};
  if (!camera.valid()) return Error{"camera with impossible intrinsics"};
  return camera;
}

Camera rounded_for_wire(const Camera& camera) {
  Camera rounded = camera;
  for (double* value : {&rounded.fx, &rounded.fy, &rounded.cx, &rounded.cy}) {
    *value = static_cast<double>(static_cast<float>(*value));
  }
  return rounded;
}

std::uint32_t camera_hash(const Camera& camera) {
  ByteWriter writer;
  put_camera(writer, camera);
  const std::uint32_t sum = crc32(writer.bytes());
  return sum == 0 ? 1 : sum;
}

}  // namespace rprr
