// SPDX-License-Identifier: BSD-3-Clause
#include "colour/pgf_container.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "colour/checks.hpp"
#include "rprr_codec/colour_codec.hpp"
#include "rprr_wire/bytes.hpp"
#include "wire_numbers.hpp"

namespace rprr {
namespace {

constexpr std::uint8_t kVersion = 2;
constexpr int kMinSide = 16;
constexpr int kMaxLevels = 30;  // libpgf's
// libpgf's file (PGFtypes.h): "PGF", version flags, length of the header, header, level lengths.
constexpr std::uint8_t kMagic[] = {'P', 'G', 'F'};
constexpr std::uint32_t kHeaderBytes = 16;
constexpr std::uint8_t kBitsPerPixel = 24;
constexpr std::uint8_t kChannels = 3;
constexpr std::uint8_t kRgb = 3;              // ImageModeRGBColor
constexpr std::uint8_t kBitsPerChannel = 8;   // as libpgf fills it in
constexpr std::uint16_t kLibraryVersion = 7;  // major in the lowest four bits; the rest is a date

std::uint64_t sum(const std::vector<std::uint32_t>& lengths) {
  return std::accumulate(lengths.begin(), lengths.end(), std::uint64_t{0});
}

}  // namespace

cv::Size pgf_coded_size(cv::Size size) {
  return {std::max(size.width, kMinSide), std::max(size.height, kMinSide)};
}

Result<PgfParts> parse_pgf_payload(ByteView payload) {
  ByteReader reader(unseal(payload));
  PgfParts parts;
  const auto version = reader.get<std::uint8_t>();
  parts.format = reader.get<std::uint8_t>();
  parts.quality = reader.get<std::uint8_t>();
  parts.levels = reader.get<std::uint8_t>();
  parts.coarse = reader.get<std::uint8_t>();
  const int width = reader.get<std::uint16_t>();
  const int height = reader.get<std::uint16_t>();
  if (!reader.ok()) return Error{"colour payload damaged or cut short"};
  if (version != kVersion) return Error{"colour payload of an unknown version"};
  const Result<cv::Size> size = possible_size(width, height);
  if (!size) return Error{size.reason()};
  parts.size = *size;
  if (parts.levels > kMaxLevels || parts.coarse >= parts.levels) {
    return Error{"colour payload with impossible levels"};
  }
  parts.lengths.resize(static_cast<std::size_t>(parts.levels - parts.coarse));
  for (std::uint32_t& length : parts.lengths) {
    if (!get_varint(reader, length)) return Error{"colour payload damaged or cut short"};
  }
  parts.data = reader.get_view(reader.left());
  if (sum(parts.lengths) != parts.data.size) return Error{"colour payload's levels do not add up"};
  return parts;
}

Bytes pgf_payload(const PgfParts& parts) {
  ByteWriter writer;
  writer.bytes().reserve(parts.data.size + 64);
  writer.put(kVersion);
  writer.put(parts.format);
  writer.put(parts.quality);
  writer.put(static_cast<std::uint8_t>(parts.levels));
  writer.put(static_cast<std::uint8_t>(parts.coarse));
  writer.put(static_cast<std::uint16_t>(parts.size.width));
  writer.put(static_cast<std::uint16_t>(parts.size.height));
  for (const std::uint32_t length : parts.lengths) put_varint(writer, length);
  writer.append(parts.data);
  Bytes payload = writer.take();
  seal(payload);
  return payload;
}

Bytes pgf_file(const PgfParts& parts) {
  const cv::Size size = pgf_coded_size(parts.size);
  ByteWriter writer;
  writer.bytes().reserve(parts.data.size + 160);
  writer.append({kMagic, sizeof(kMagic)});
  writer.put(parts.format);
  writer.put(kHeaderBytes);
  writer.put(static_cast<std::uint32_t>(size.width));
  writer.put(static_cast<std::uint32_t>(size.height));
  writer.put(static_cast<std::uint8_t>(parts.levels));
  for (const std::uint8_t byte : {parts.quality, kBitsPerPixel, kChannels, kRgb, kBitsPerChannel}) {
    writer.put(byte);
  }
  writer.put(kLibraryVersion);
  for (const std::uint32_t length : parts.lengths) writer.put(length);
  for (int level = 0; level < parts.coarse; ++level) writer.put(std::uint32_t{0});
  writer.append(parts.data);
  return writer.take();
}

Result<PgfParts> parse_pgf_file(ByteView file, cv::Size size) {
  ByteReader reader(file);
  PgfParts parts;
  parts.size = size;
  const ByteView magic = reader.get_view(sizeof(kMagic));
  parts.format = reader.get<std::uint8_t>();
  const auto header_bytes = reader.get<std::uint32_t>();
  reader.get_view(8);  // width and height
  parts.levels = reader.get<std::uint8_t>();
  parts.quality = reader.get<std::uint8_t>();
  reader.get_view(6);  // what is the same in every image of ours
  if (!reader.ok() || std::memcmp(magic.data, kMagic, sizeof(kMagic)) != 0 ||
      header_bytes != kHeaderBytes || parts.levels < 1 || parts.levels > kMaxLevels) {
    return Error{"libpgf is of another version"};
  }
  parts.lengths.resize(static_cast<std::size_t>(parts.levels));
  for (std::uint32_t& length : parts.lengths) length = reader.get<std::uint32_t>();
  parts.data = reader.get_view(reader.left());
  if (sum(parts.lengths) != parts.data.size) return Error{"libpgf's levels do not add up"};
  return parts;
}

Result<int> pgf_levels(ByteView payload) {
  const Result<PgfParts> parts = parse_pgf_payload(payload);
  return parts ? Result<int>(parts->levels) : Result<int>(Error{parts.reason()});
}

Result<Bytes> pgf_cut(ByteView payload, int coarse) {
  Result<PgfParts> parts = parse_pgf_payload(payload);
  if (!parts) return Error{parts.reason()};
  if (coarse < parts->coarse || coarse >= parts->levels) {
    return Error{"colour payload has no level " + std::to_string(coarse)};
  }
  parts->coarse = coarse;
  parts->lengths.resize(static_cast<std::size_t>(parts->levels - coarse));
  parts->data = parts->data.first(static_cast<std::size_t>(sum(parts->lengths)));
  return pgf_payload(*parts);
}

}  // namespace rprr
