// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/samples_wire.hpp"
#include "rprr_wire/bytes.hpp"
#include "rprr_wire/camera_wire.hpp"

#include <algorithm>
#include <cmath>

namespace rprr {
namespace {

constexpr std::uint8_t kNarrow = 1;
constexpr std::uint8_t kWide = 2;
constexpr std::uint8_t kHasCamera = 1;
constexpr std::uint8_t kHasNormals = 2;
constexpr std::size_t kMaxPoints = 4096;

struct Layout {
  unsigned column_bits;
  unsigned row_bits;
  unsigned bits() const { return column_bits + row_bits + 16; }
  std::size_t bytes(std::size_t points) const { return (points * bits() + 7) / 8; }
};

Layout layout_of(std::uint8_t version) {
  return version == kNarrow ? Layout{10, 9} : Layout{13, 13};
}

void put_points(ByteWriter& writer, const std::vector<SamplePoint>& points, const Layout& layout) {
  std::uint64_t pending = 0;
  unsigned filled = 0;
  for (const SamplePoint& point : points) {
    std::uint64_t packed = point.column;
    packed |= std::uint64_t{point.row} << layout.column_bits;
    packed |= std::uint64_t{point.counts} << (layout.column_bits + layout.row_bits);
    pending |= packed << filled;  // at most 7 + 42 bits
    for (filled += layout.bits(); filled >= 8; filled -= 8) {
      writer.put(static_cast<std::uint8_t>(pending));
      pending >>= 8;
    }
  }
  if (filled > 0) writer.put(static_cast<std::uint8_t>(pending));
}

std::vector<SamplePoint> get_points(ByteView bytes, std::size_t count, const Layout& layout) {
  std::vector<SamplePoint> points(count);
  const std::uint64_t column_mask = (std::uint64_t{1} << layout.column_bits) - 1;
  const std::uint64_t row_mask = (std::uint64_t{1} << layout.row_bits) - 1;
  std::uint64_t pending = 0;
  unsigned filled = 0;
  std::size_t at = 0;
  for (SamplePoint& point : points) {
    for (; filled < layout.bits(); filled += 8)
      pending |= std::uint64_t{bytes.data[at++]} << filled;
    point.column = static_cast<std::uint16_t>(pending & column_mask);
    point.row = static_cast<std::uint16_t>(pending >> layout.column_bits & row_mask);
    point.counts =
        static_cast<std::uint16_t>(pending >> (layout.column_bits + layout.row_bits) & 0xFFFF);
    pending >>= layout.bits();
    filled -= layout.bits();
  }
  return points;
}

float sign_of(float value) {
  return value < 0.0f ? -1.0f : 1.0f;
}

// Octahedral normals (Cigolle et al. 2014): the sphere unfolded onto a square.
void put_normal(ByteWriter& writer, const Eigen::Vector3f& normal) {
  const float size = normal.cwiseAbs().sum();
  // (-128, -128) is no point of the square and stands for "no normal".
  if (!(size > 0.0f)) {
    writer.put<std::int8_t>(-128);
    writer.put<std::int8_t>(-128);
    return;
  }
  Eigen::Vector2f p = normal.head<2>() / size;
  if (normal.z() < 0.0f) {
    p = Eigen::Vector2f((1.0f - std::abs(p.y())) * sign_of(p.x()),
                        (1.0f - std::abs(p.x())) * sign_of(p.y()));
  }
  for (int i = 0; i < 2; ++i) writer.put(static_cast<std::int8_t>(std::lround(p[i] * 127.0f)));
}

Eigen::Vector3f get_normal(ByteReader& reader) {
  const auto x = reader.get<std::int8_t>();
  const auto y = reader.get<std::int8_t>();
  if (x == -128 || y == -128) return Eigen::Vector3f::Zero();
  Eigen::Vector2f p(static_cast<float>(x) / 127.0f, static_cast<float>(y) / 127.0f);
  const float z = 1.0f - std::abs(p.x()) - std::abs(p.y());
  if (z < 0.0f) {
    p = Eigen::Vector2f((1.0f - std::abs(p.y())) * sign_of(p.x()),
                        (1.0f - std::abs(p.x())) * sign_of(p.y()));
  }
  return Eigen::Vector3f(p.x(), p.y(), z).normalized();
}

}  // namespace

Bytes encode_samples(const SamplesContent& content, int image_width, int image_height) {
  const std::uint8_t version = image_width <= 1024 && image_height <= 512 ? kNarrow : kWide;
  const std::size_t count = std::min(content.points.size(), kMaxPoints);
  const std::vector<SamplePoint> points(
      content.points.begin(), content.points.begin() + static_cast<std::ptrdiff_t>(count));
  ByteWriter writer;
  writer.put(version);
  writer.put(static_cast<std::uint8_t>((content.camera ? kHasCamera : 0) |
                                       (content.with_normals ? kHasNormals : 0)));
  writer.put(content.iteration);
  writer.put(content.camera_hash);
  writer.put(content.known_peer_hash);
  if (content.camera) put_camera(writer, *content.camera);
  writer.put(static_cast<float>(content.unit));
  writer.put(static_cast<std::uint16_t>(count));
  put_points(writer, points, layout_of(version));
  if (content.with_normals) {
    for (const SamplePoint& point : points) put_normal(writer, point.normal);
  }
  Bytes bytes = writer.take();
  seal(bytes);
  return bytes;
}

bool are_of_dependent(ByteView bytes) {
  return bytes.size > 1 && (bytes.data[1] & kHasNormals) != 0;
}

Result<SamplesContent> decode_samples(ByteView bytes) {
  ByteReader reader(unseal(bytes));
  const auto version = reader.get<std::uint8_t>();
  const auto flags = reader.get<std::uint8_t>();
  SamplesContent content;
  content.iteration = reader.get<std::uint8_t>();
  content.camera_hash = reader.get<std::uint32_t>();
  content.known_peer_hash = reader.get<std::uint32_t>();
  if (!reader.ok()) return Error{"samples damaged or cut short"};
  if (version != kNarrow && version != kWide) return Error{"samples of an unknown version"};
  if ((flags & ~(kHasCamera | kHasNormals)) != 0) return Error{"samples with unknown flags"};
  if ((flags & kHasCamera) != 0) {
    const Result<Camera> camera = get_camera(reader);
    if (!camera) return Error{"samples: " + camera.reason()};
    if (camera_hash(*camera) != content.camera_hash)
      return Error{"samples: camera and hash differ"};
    content.camera = *camera;
  }
  content.with_normals = (flags & kHasNormals) != 0;
  // Back to the decimal that both ends mean: 0.001f is not 0.001.
  content.unit = std::round(static_cast<double>(reader.get<float>()) * 1e9) * 1e-9;
  const std::size_t count = reader.get<std::uint16_t>();
  if (!reader.ok() || !(content.unit > 1e-7) || !(content.unit < 1.0)) {
    return Error{"samples with an impossible depth unit"};
  }
  const Layout layout = layout_of(version);
  const std::size_t normal_bytes = content.with_normals ? 2 * count : 0;
  if (count > kMaxPoints || reader.left() != layout.bytes(count) + normal_bytes) {
    return Error{"samples with a length that does not fit their count"};
  }
  content.points = get_points(reader.get_view(layout.bytes(count)), count, layout);
  for (SamplePoint& point : content.points) {
    if (point.counts == 0) return Error{"samples with a point without depth"};
    if (content.with_normals) point.normal = get_normal(reader);
  }
  return content;
}

}  // namespace rprr
